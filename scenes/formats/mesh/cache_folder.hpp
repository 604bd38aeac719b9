#pragma once
// Where beambench keeps what can be made again.

#include <filesystem>
#include <optional>

namespace beambench::scenes::mesh {

/// $BEAMBENCH_CACHE, or `beambench` in $XDG_CACHE_HOME, or in ~/.cache; nothing where the
/// environment names no such place. Need not exist. scripts/meshes finds it the same way.
std::optional<std::filesystem::path> cache_folder();

}  // namespace beambench::scenes::mesh

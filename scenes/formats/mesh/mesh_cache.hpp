#pragma once
// The cache folder, and in it the meshes that were imported before, in a form that is fast to read.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "scenes/formats/mesh/mesh.hpp"

namespace beambench::scenes::mesh {

/// $BEAMBENCH_CACHE, or `beambench` in $XDG_CACHE_HOME, or in ~/.cache; nothing where the
/// environment names no such place. Need not exist. scripts/meshes finds it the same way.
std::optional<std::filesystem::path> cache_folder();

/// XXH3 of the bytes.
std::uint64_t content_hash(std::string_view bytes);

/// Names a mesh by what it was made from: the bytes of its file, the ending that says how to read
/// them, and the importer (`importer_of`). As good as a file name.
std::string mesh_key(std::string_view bytes, std::string_view ending, std::string_view importer);

/// The result of a lookup.
struct CachedMesh {
  enum class State { kFound, kMissing, kDamaged };

  State state = State::kMissing;
  ImportedMesh mesh;
};

/// Looks for the mesh of that key in a folder. One whose companions (looked for in `mesh_folder`)
/// are no longer what they were counts as missing; a file that is cut off, or that its checksum
/// does not match, as damaged. Never throws for what a file holds.
CachedMesh find_cached_mesh(const std::filesystem::path& folder, const std::string& key,
                            const std::filesystem::path& mesh_folder);

/// Puts a mesh there, whole or not at all; makes the folder. False when that was not possible.
bool cache_mesh(const std::filesystem::path& folder, const std::string& key,
                const ImportedMesh& mesh);

}  // namespace beambench::scenes::mesh

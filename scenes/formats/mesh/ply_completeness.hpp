#pragma once
// Is all of a PLY file there?

#include <filesystem>
#include <string_view>

namespace beambench::scenes::mesh {

/// Throws InputError naming the file when its header tells of more than follows: Assimp fills up
/// what is missing with what it read last. A header that is no PLY header is left to Assimp.
void require_complete_ply(std::string_view bytes, const std::filesystem::path& path);

}  // namespace beambench::scenes::mesh

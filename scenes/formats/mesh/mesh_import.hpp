#pragma once
// Reads the triangles of mesh files.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "scenes/formats/mesh/mesh.hpp"

namespace beambench::scenes::mesh {

/// Distinguishes importers that might read one file differently; part of the key of the cache.
std::uint32_t importer_version();

/// Reads a mesh from the bytes of a file; `ending` says its format. Its polygons become triangles,
/// in world space, right-handed; points, lines and triangles without area are left out with a
/// warning. `path` is for messages and for finding companions. Throws InputError when the file
/// is malformed, has no triangles, or holds numbers that no scene can, and in a build without
/// Assimp always.
ImportedMesh import_mesh(std::string_view bytes, const std::string& ending,
                         const std::filesystem::path& path);

/// As import_mesh, in a process of its own: for some malformed or truncated files Assimp ends the
/// process, or never returns. Throws InputError then, too: the file may need 2 s of
/// processor time, and another second for each MiB.
ImportedMesh guarded_import(std::string_view bytes, const std::string& ending,
                            const std::filesystem::path& path);

/// Throws InputError naming the file when its header declares more than follows: Assimp fills up
/// what is missing with what it read last. A header that is no PLY header is left to Assimp.
void require_complete_ply(std::string_view bytes, const std::filesystem::path& path);

}  // namespace beambench::scenes::mesh

#pragma once
// Reads the triangles of mesh files.

#include <filesystem>
#include <string>
#include <string_view>

#include "scenes/formats/mesh/mesh.hpp"

namespace beambench::scenes::mesh {

/// The importer that reads files of an ending, with what distinguishes its versions that might read
/// one file differently (`tinygltf-1`); part of the key of the cache. Empty in a build without the
/// library that it needs: tinygltf for glTF, tinyobjloader for OBJ, Assimp for the others.
std::string importer_of(std::string_view ending);

/// Reads a mesh from the bytes of a file; `ending` says its format. Its polygons become triangles,
/// in world space, right-handed; points, lines and triangles without area are left out with a
/// warning. `path` is for messages and for finding companions, which are read from its folder
/// alone. Throws InputError when the file is malformed, has no triangles, or holds numbers that no
/// scene can, and in a build without its importer always.
ImportedMesh import_mesh(std::string_view bytes, const std::string& ending,
                         const std::filesystem::path& path);

/// As import_mesh, in a process of its own: for some malformed or truncated files a library ends
/// the process, or never returns. Throws InputError then, too: the file may need 2 s of processor
/// time (glTF, of which a short one may place a mesh many times, 2 minutes), and another second for
/// each MiB.
ImportedMesh guarded_import(std::string_view bytes, const std::string& ending,
                            const std::filesystem::path& path);

/// Throws InputError naming the file when its header declares more than follows: Assimp fills up
/// what is missing with what it read last. A header that is no PLY header is left to Assimp.
void require_complete_ply(std::string_view bytes, const std::filesystem::path& path);

}  // namespace beambench::scenes::mesh

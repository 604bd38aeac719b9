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
/// warning. `path` is for messages and tells where companions lie. Throws InputError when the file
/// is malformed, has no triangles, or holds numbers that no scene can, and in a build without
/// Assimp always.
ImportedMesh import_mesh(std::string_view bytes, const std::string& ending,
                         const std::filesystem::path& path);

}  // namespace beambench::scenes::mesh

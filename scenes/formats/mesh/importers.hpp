#pragma once
// The importers of mesh files, and their common parts.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/formats/mesh/mesh.hpp"
#include "scenes/formats/mesh/mesh_cleaning.hpp"

namespace beambench::scenes::mesh {

/// Reads files of some formats.
struct Importer {
  /// `library-version`, or `format-version` for beambench's own readers; it changes whenever a file
  /// might be read differently. Empty in a build without the library.
  std::string name;
  /// The implementation of `import_mesh`.
  ImportedMesh (*import)(std::string_view bytes, const std::string& ending,
                         const std::filesystem::path& path);
};

/// Reads glTF 2.0 (`.gltf`, `.glb`), with tinygltf.
Importer gltf_importer();
/// Reads OBJ with its material libraries, with beambench's own reader.
Importer obj_importer();
/// Read PLY, OFF and STL, with beambench's own readers, which are in every build.
Importer ply_importer();
Importer off_importer();
Importer stl_importer();
/// Reads all other formats, with Assimp.
Importer assimp_importer();

/// Throws an InputError stating that this build lacks the library for the file. `package` is the
/// Debian package.
[[noreturn]] void refuse_missing_library(const std::filesystem::path& path,
                                         std::string_view library, std::string_view package);

/// Runs one of beambench's own readers on the bytes of a file. Prefixes its errors with the file's
/// name.
ImportedMesh with_file_name(const std::filesystem::path& path, std::string_view bytes,
                            ImportedMesh (*read)(std::string_view));

/// Returns the surface of a mesh without materials: unpainted clay.
Surface clay();

/// Returns the collected mesh with warnings about omitted parts. Throws InputError, without the
/// file's name, if it has no triangles.
ImportedMesh collected_mesh(MeshCollector&& collector, std::size_t points_and_lines);

}  // namespace beambench::scenes::mesh

#pragma once
// The ways in which mesh files are read, and what they share.

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
  /// `library-version`, or `format-version` of our own readers; another one for whatever might read
  /// a file differently. Empty in a build without the library.
  std::string name;
  /// As `import_mesh`.
  ImportedMesh (*import)(std::string_view bytes, const std::string& ending,
                         const std::filesystem::path& path);
};

/// glTF 2.0 (`.gltf`, `.glb`), by tinygltf.
Importer gltf_importer();
/// OBJ with its material libraries, by a reader of our own.
Importer obj_importer();
/// PLY, OFF and STL, by readers of our own, which are in every build.
Importer ply_importer();
Importer off_importer();
Importer stl_importer();
/// All other formats, by Assimp.
Importer assimp_importer();

/// Throws InputError: this build cannot read the file, because a library was missing. `package` is
/// Debian's.
[[noreturn]] void refuse_missing_library(const std::filesystem::path& path,
                                         std::string_view library, std::string_view package);

/// Returns what a reader of our own makes of the bytes of a file. Puts the file's name before its
/// errors.
ImportedMesh with_file_name(const std::filesystem::path& path, std::string_view bytes,
                            ImportedMesh (*read)(std::string_view));

/// Of a mesh without materials: unpainted clay.
Surface clay();

/// The collected mesh, with warnings of what was left out. Throws InputError, without the file's
/// name, when no triangle is in it.
ImportedMesh collected_mesh(MeshCollector&& collector, std::size_t points_and_lines);

}  // namespace beambench::scenes::mesh

#pragma once
// Reads the triangles of mesh files.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "scenes/formats/mesh/mesh.hpp"

namespace beambench::scenes::mesh {

/// The importer that reads files of an ending, with what distinguishes its versions that might read
/// one file differently (`tinygltf-1`); part of the key of the cache. Empty in a build without the
/// library that it needs: tinygltf for glTF, none for OBJ, PLY, OFF and STL, Assimp for the others.
std::string importer_of(std::string_view ending);

/// Reads a mesh from the bytes of a file; `ending` says its format. Its polygons become triangles,
/// in world space, right-handed; points, lines and triangles without area are left out with a
/// warning. `path` is for messages and for finding companions, which are read from its folder
/// alone. Throws InputError when the file is malformed, has no triangles, or holds numbers that no
/// scene can, and in a build without its importer always.
ImportedMesh import_mesh(std::string_view bytes, const std::string& ending,
                         const std::filesystem::path& path);

/// What the import of one file may take.
struct ImportLimits {
  std::chrono::seconds processor;     ///< time of the processor
  std::chrono::milliseconds elapsed;  ///< until the whole mesh is here
  std::uint64_t memory;               ///< bytes, beyond what this process has
};

/// What is enough for any valid file of that size: 2 s of processor time and another for each MiB
/// (for glTF, of which a short file may place a mesh many times, 2 minutes); ten times as long, and
/// half a minute, by the clock; and 4 GiB of memory and 64 bytes for each byte (glTF: 32 GiB), but
/// no more than is available (`available_memory`).
ImportLimits import_limits(std::string_view bytes, std::string_view ending);

/// As import_mesh, in a process of its own: for some malformed or truncated files a library ends
/// the process, never returns, or takes all memory. Throws InputError then, too, and when a limit
/// is exceeded.
ImportedMesh guarded_import(std::string_view bytes, const std::string& ending,
                            const std::filesystem::path& path, const ImportLimits& limits);

}  // namespace beambench::scenes::mesh

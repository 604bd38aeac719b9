#pragma once
// Reads the triangles of mesh files.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "scenes/formats/mesh/mesh.hpp"

namespace beambench::scenes::mesh {

/// Returns the importer for an ending, with a suffix for each version that might read a file
/// differently (`tinygltf-1`); part of the cache key. Empty in a build without the library that it
/// needs: tinygltf for glTF, none for OBJ, PLY, OFF and STL, Assimp for the others.
std::string importer_of(std::string_view ending);

/// Reads a mesh from the bytes of a file in the format denoted by `ending`. Its polygons become
/// triangles, in world space, right-handed; points, lines and triangles without area are left out
/// with a warning. `path` is used in messages and to find companions, which are read only from its
/// folder. Throws InputError if the file is malformed, has no triangles or has numbers that are
/// invalid in a scene. In a build without the importer, always throws InputError.
ImportedMesh import_mesh(std::string_view bytes, const std::string& ending,
                         const std::filesystem::path& path);

/// The resources that the import of one file may use.
struct ImportLimits {
  std::chrono::seconds processor;     ///< processor time
  std::chrono::milliseconds elapsed;  ///< until the whole mesh has arrived
  std::uint64_t memory;               ///< bytes, in addition to this process's current use
};

/// Returns limits that suffice for any valid file of that size. Processor time: 2 s plus 1 s per
/// MiB (for glTF, where a short file may place a mesh many times, 2 minutes). Wall time: ten times
/// as long plus half a minute. Memory: 4 GiB plus 64 bytes per byte (glTF: 32 GiB), but no more
/// than is available (`available_memory`).
ImportLimits import_limits(std::string_view bytes, std::string_view ending);

/// Runs import_mesh in a separate process: with some malformed or truncated files, a library
/// aborts, never returns, or takes all memory. Also throws InputError in these cases and if a limit
/// is exceeded.
ImportedMesh guarded_import(std::string_view bytes, const std::string& ending,
                            const std::filesystem::path& path, const ImportLimits& limits);

}  // namespace beambench::scenes::mesh

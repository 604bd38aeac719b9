#pragma once
// The cache folder, which contains imported meshes in a form that is fast to read.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "scenes/formats/mesh/mesh.hpp"

namespace beambench::scenes::mesh {

/// Returns $BEAMBENCH_CACHE, or `beambench` in $XDG_CACHE_HOME, or in ~/.cache; nothing if the
/// environment defines none of them. It need not exist. scripts/meshes uses the same rule.
std::optional<std::filesystem::path> cache_folder();

/// Returns XXH3 of the bytes.
std::uint64_t content_hash(std::string_view bytes);

/// Returns the key of a mesh, derived from the bytes of its file, the ending that determines how to
/// read them, and the importer (`importer_of`). Safe as a file name.
std::string mesh_key(std::string_view bytes, std::string_view ending, std::string_view importer);

/// The result of a lookup.
struct CachedMesh {
  enum class State { kFound, kMissing, kDamaged };

  State state = State::kMissing;
  ImportedMesh mesh;
};

/// Looks for the mesh with that key in a folder. A mesh whose companions (looked up in
/// `mesh_folder`) have changed counts as missing; a file that is truncated or does not match its
/// checksum counts as damaged. Never throws because of a file's contents.
CachedMesh find_cached_mesh(const std::filesystem::path& folder, const std::string& key,
                            const std::filesystem::path& mesh_folder);

/// Stores a mesh atomically; creates the folder. Returns false on failure.
bool cache_mesh(const std::filesystem::path& folder, const std::string& key,
                const ImportedMesh& mesh);

}  // namespace beambench::scenes::mesh

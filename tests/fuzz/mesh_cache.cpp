// The mesh cache: a damaged file does no more harm than a missing one.

#include "scenes/formats/mesh/mesh_cache.hpp"

#include <new>
#include <optional>
#include <stdexcept>

#include "scenes/formats/mesh/mesh.hpp"
#include "tests/fuzz/imported_mesh.hpp"
#include "tests/fuzz/scratch_folder.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace beambench;

/// Decodes the bytes after a header, which a mutated file never reaches because its checksum is
/// wrong.
std::optional<scenes::mesh::ImportedMesh> decoded(std::string_view bytes) {
  try {
    return scenes::mesh::decode(bytes);
  } catch (const std::out_of_range&) {
  } catch (const std::bad_alloc&) {
  }
  return std::nullopt;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::ScratchFolder folder;
  const std::string_view bytes = fuzz::text_of(data, size);
  folder.write("key.mesh", bytes);
  const auto cached = scenes::mesh::find_cached_mesh(folder.path(), "key", folder.path());
  if (cached.state == scenes::mesh::CachedMesh::State::kFound) fuzz::check_imported(cached.mesh);
  decoded(bytes);
  return 0;
}

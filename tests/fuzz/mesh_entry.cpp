// Entries of the mesh registry: the JSON that users write for `mesh:NAME`.

#include <cstdlib>

#include "scenes/formats/mesh/mesh_registry.hpp"
#include "tests/fuzz/scratch_folder.hpp"
#include "tests/fuzz/target.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace beambench;
  static const fuzz::ScratchFolder folder;
  static const int cache = ::setenv("BEAMBENCH_CACHE", folder.path().c_str(), 1);
  fuzz::require(cache == 0, "the cache cannot be named");
  folder.write("registered/input.json", fuzz::text_of(data, size));
  fuzz::accepted([] { return scenes::mesh::find_registered_mesh("input"); });
  return 0;
}

// The check that a PLY file is complete, which comes before Assimp reads it.

#include "scenes/formats/mesh/mesh_import.hpp"
#include "tests/fuzz/target.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace beambench;
  fuzz::accepted([&] {
    scenes::mesh::require_complete_ply(fuzz::text_of(data, size), "input.ply");
    return true;
  });
  return 0;
}

// Packed mesh files.

#include <string>

#include "scenes/formats/mesh/mesh_file.hpp"
#include "tests/fuzz/target.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace beambench;
  const auto bytes = fuzz::accepted(
      [&] { return scenes::mesh::gunzip(fuzz::text_of(data, size), "input.ply.gz"); });
  fuzz::require(!bytes || !bytes->empty(), "an empty file was not refused");
  return 0;
}

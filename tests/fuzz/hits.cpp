// Hit files, binary and CSV, read in parts.

#include <cstddef>

#include "harness/rays/claimed_hits.hpp"
#include "harness/rays/hit_file.hpp"
#include "tests/fuzz/scratch_folder.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace beambench;

/// Reads all hits of a file, in parts of odd size. Returns their number.
std::size_t read_all(const std::filesystem::path& file) {
  constexpr std::size_t kPart = 7;
  rays::HitReader reader(file);
  rays::HitTable hits;
  std::size_t read = 0;
  while (const std::size_t count = reader.read(kPart, hits)) {
    fuzz::require(count <= kPart && hits.view().size() == count, "a part has another size");
    fuzz::require(!reader.place_of(read).empty(), "a hit has no place");
    read += count;
  }
  fuzz::require(!reader.count() || *reader.count() == read, "the file has another count of hits");
  return read;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::ScratchFolder folder;
  const auto file = folder.write("input.hits", fuzz::text_of(data, size));
  fuzz::accepted([&] { return read_all(file); });
  return 0;
}

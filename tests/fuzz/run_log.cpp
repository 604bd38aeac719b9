// The file of a finished cell, from which a run is resumed and results.csv is written.

#include "harness/bench/record/run_folder.hpp"
#include "tests/fuzz/scratch_folder.hpp"
#include "tests/fuzz/target.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace beambench;
  static const fuzz::ScratchFolder folder;
  folder.write("manifest.json", "{}");
  folder.write("cells/cell.json", fuzz::text_of(data, size));
  fuzz::accepted([] {
    bench::RunFolder run = bench::RunFolder::open(folder.path());
    run.write_results();
    return true;
  });
  return 0;
}

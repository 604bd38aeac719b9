// The manifest and the sweep of a run that is to be resumed: is it the same?

#include "harness/bench/record/manifest.hpp"

#include <nlohmann/json.hpp>

#include "harness/bench/record/run_folder.hpp"
#include "tests/fuzz/scratch_folder.hpp"
#include "tests/fuzz/target.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace beambench;
  static const fuzz::ScratchFolder folder;
  folder.write("manifest.json", fuzz::text_of(data, size));
  fuzz::accepted([] {
    folder.write("config.json", "{}");
    const bench::RunFolder run = bench::RunFolder::open(folder.path());
    bench::Manifest now;
    bench::require_same_run(run, nlohmann::json::object(), to_json(now));
    bench::continue_with(now, run.read_json("manifest.json"));
    return true;
  });
  return 0;
}

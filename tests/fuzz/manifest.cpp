// The manifest of a run that is to be resumed: is it the same run? An input is what differs (RFC
// 7396) from the manifest that this program would write, or else the whole file.

#include "harness/bench/record/manifest.hpp"

#include <chrono>
#include <string>

#include <nlohmann/json.hpp>

#include "harness/bench/record/run_folder.hpp"
#include "tests/fuzz/scratch_folder.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace beambench;

std::string changed(const nlohmann::ordered_json& manifest, std::string_view input) {
  const auto patch = nlohmann::ordered_json::parse(input, nullptr, /*allow_exceptions=*/false);
  if (!patch.is_object()) return std::string(input);
  nlohmann::ordered_json result = manifest;
  result.merge_patch(patch);
  return result.dump();
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::ScratchFolder folder;
  static const nlohmann::ordered_json now =
      to_json(bench::begin_manifest("fuzz", {}, -1, 1, std::chrono::seconds(0)));
  folder.write("manifest.json", changed(now, fuzz::text_of(data, size)));
  folder.write("config.json", "{}");
  fuzz::accepted([] {
    const bench::RunFolder run = bench::RunFolder::open(folder.path());
    bench::require_same_run(run, nlohmann::json::object(), now);
    return true;
  });
  return 0;
}

// Checks whether the manifest of a run to be resumed belongs to the same run. An input is either
// the difference (RFC 7396) from the manifest that this program would write, or a whole manifest.

#include "harness/measure/record/manifest.hpp"

#include <chrono>
#include <string>

#include <nlohmann/json.hpp>

#include "harness/measure/record/run_log.hpp"
#include "scenes/base/json_text.hpp"
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

/// Returns a log with only a header.
std::string header_with(const std::string& manifest) {
  return R"({"event":"header","schema_version":1,"manifest":)" + manifest +
         R"(,"config":{},"plan":[]})" + '\n';
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::ScratchFolder folder;
  static const nlohmann::ordered_json now =
      to_json(measure::begin_manifest("fuzz", {}, -1, 1, std::chrono::seconds(0)));
  folder.write(measure::kLogName, header_with(changed(now, fuzz::text_of(data, size))));
  fuzz::accepted([] {
    const measure::Run run = measure::read_run(folder.path());
    measure::require_same_run(folder.path(), run, nlohmann::json::object(), now);
    return read_as_written(measure::kLogName, "", [&] {
      measure::Manifest resumed;
      measure::continue_with(resumed, run.manifest);
      return true;
    });
  });
  return 0;
}

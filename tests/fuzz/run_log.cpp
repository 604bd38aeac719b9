// The log of a run, from which the run is resumed and all of its files are generated. An input
// consists of lines of events, in which `"manifest":{}` denotes a complete manifest.

#include "harness/measure/record/run_log.hpp"

#include <chrono>
#include <sstream>
#include <string>

#include <nlohmann/json.hpp>

#include "harness/analysis/analysis.hpp"
#include "harness/analysis/results_csv.hpp"
#include "harness/analysis/words.hpp"
#include "harness/measure/record/manifest.hpp"
#include "scenes/base/json_text.hpp"
#include "tests/fuzz/scratch_folder.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace beambench;

/// Returns the input with the empty manifest replaced by a complete one.
std::string with_manifest(std::string text) {
  static const std::string manifest =
      to_json(measure::begin_manifest("fuzz", {}, -1, 1, std::chrono::seconds(0))).dump();
  constexpr std::string_view kEmpty = R"("manifest":{})";
  for (auto place = text.find(kEmpty); place != std::string::npos;
       place = text.find(kEmpty, place)) {
    text.replace(place + kEmpty.size() - 2, 2, manifest);
    place += kEmpty.size() - 2 + manifest.size();
  }
  return text;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::ScratchFolder folder;
  folder.write(measure::kLogName, with_manifest(std::string(fuzz::text_of(data, size))));
  const auto run = fuzz::accepted([] { return measure::read_run(folder.path()); });
  if (!run) return 0;
  fuzz::accepted([&] {
    return read_as_written(measure::kLogName, "", [&] {
      const analysis::Analysis found = analysis::analyze(*run);
      std::ostringstream rows;
      analysis::write_results(rows, *run);
      return analysis::summary(found) + analysis::describe_contenders(found.views) +
             json_text(to_json(found)) + rows.str();
    });
  });
  return 0;
}

#include "harness/analysis/exports.hpp"

#include <ostream>
#include <string>

#include <fmt/format.h>

#include "harness/analysis/results_csv.hpp"
#include "harness/analysis/words.hpp"
#include "harness/measure/google_benchmark.hpp"
#include "harness/measure/record/conditions.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/json_text.hpp"

namespace beambench::analysis {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The fraction of the fastest contender's time above which the manifest mentions the harness's own
/// time.
constexpr double kWantedOverhead = 0.02;

/// Returns the manifest of a run, with facts added from its cells.
Json whole_manifest(const measure::Run& run, const Analysis& analysis) {
  Json manifest = run.manifest;
  Json& uncontrolled = manifest.at("uncontrolled");
  if (const auto throttled = measure::describe(measure::conditions_of(manifest).throttling)) {
    uncontrolled.push_back(fmt::format("During the run, {}.", *throttled));
  }
  if (!analysis.overheads.empty() && analysis.overheads.front().part > kWantedOverhead) {
    uncontrolled.push_back(fmt::format("The {}.", describe(analysis.overheads)));
  }
  return manifest;
}

/// Returns the context of google-benchmark.json: what the library reported at the start of the run,
/// and the program. library_build_type is that of Google Benchmark only.
Json benchmark_context(const Json& manifest) {
  const Json& program = manifest.at("program");
  Json context = manifest.value("google_benchmark", Json::object());
  context.update({{"host_name", manifest.at("machine").at("id")},
                  {"beambench_run_id", manifest.at("run_id")},
                  {"beambench_commit", program.at("commit")},
                  {"beambench_dirty", program.at("dirty")},
                  {"beambench_build_type", program.at("build_type")},
                  {"beambench_isa", manifest.at("measurement").at("isa")}});
  return context;
}

void write_exports(const fs::path& folder, const measure::Run& run, const Analysis& analysis) {
  const Json manifest = whole_manifest(run, analysis);
  write_file(folder / "config.json", json_text(run.config) + '\n');
  write_file(folder / "manifest.json", json_text(manifest) + '\n');
  write_file(folder / "analysis.json", json_text(to_json(analysis)) + '\n');
  write_file(folder / "summary.txt", summary(analysis));
  write_file(folder / "results.csv", [&](std::ostream& out) { write_results(out, run); });
  write_file(folder / "google-benchmark.json", [&](std::ostream& out) {
    measure::write_google_benchmark_json(out, benchmark_context(manifest), run.cells);
  });
}

}  // namespace

Analysis conclude(const fs::path& folder) {
  const measure::Run run = measure::read_run(folder);
  return read_as_written((folder / measure::kLogName).string(), "begin a new run with -o", [&] {
    const Analysis analysis = analyze(run);
    write_exports(folder, run, analysis);
    return analysis;
  });
}

}  // namespace beambench::analysis

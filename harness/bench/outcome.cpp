#include "harness/bench/outcome.hpp"

#include <array>
#include <ostream>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/base/messages.hpp"
#include "harness/bench/google_benchmark.hpp"
#include "harness/verify/differ.hpp"
#include "scenes/core/files.hpp"

namespace beambench::bench {
namespace {

using Json = nlohmann::ordered_json;

/// The members of an object that are among the names.
template <class Names>
Json members(const Json& object, const Names& names) {
  Json found = Json::object();
  for (const char* name : names) {
    if (const auto member = object.find(name); member != object.end()) found[name] = *member;
  }
  return found;
}

}  // namespace

std::string describe_verdicts(const SweepOutcome& outcome) {
  const std::size_t measured = outcome.cells - outcome.without_rays - outcome.unsupported;
  std::string out;
  if (outcome.failed > 0) {
    out = fmt::format("Hits:  {} of {} wrong or not built; these have no times\n", outcome.failed,
                      base::counted(outcome.cells, "cell"));
  } else {
    out = fmt::format("Hits:  {}, all verified\n", base::counted(measured, "cell"));
  }
  if (outcome.without_rays > 0) {
    out += fmt::format("Rays:  {} of {} have no rays over their scenes\n", outcome.without_rays,
                       base::counted(outcome.cells, "cell"));
  }
  if (outcome.unsupported > 0) {
    out += fmt::format("Cells: {} of {} have rays or primitives that the structure does not take\n",
                       outcome.unsupported, base::counted(outcome.cells, "cell"));
  }
  if (measured > outcome.failed) {
    out += outcome.doubts.empty()
               ? "Times: measured on a quiet machine, as precisely as wanted\n"
               : fmt::format("Times: to be taken with care: {}\n", fmt::join(outcome.doubts, "; "));
  }
  return out;
}

int exit_code_of(const SweepOutcome& outcome) {
  const bool measured_nothing = outcome.without_rays + outcome.unsupported == outcome.cells;
  if (measured_nothing && !outcome.is_part) return base::kInvalidInput;
  return outcome.failed > 0 ? base::kMismatch : base::kSuccess;
}

Json summary_of(const Json& cell) {
  constexpr std::array kRow{"machine_id",       "scene",
                            "camera",           "structure",
                            "parameters",       "width",
                            "height",           "samples",
                            "ray_kind",         "rays",
                            "primitives",       "query_path",
                            "verdict",          "build_ms_median",
                            "trace_ms_median",  "trace_ms_ci_low",
                            "trace_ms_ci_high", "harness_ms",
                            "stop_reason"};
  Json summary = members(cell, std::array{"key", "name", "message"});
  summary["row"] = members(cell.at("row"), kRow);
  Json& repetitions = summary["repetitions"] = Json::array();
  for (const Json& each : cell.at("repetitions")) {
    repetitions.push_back(members(each, std::array{"round", "trace_ms"}));
  }
  return summary;
}

std::vector<Json> summaries(const RunFolder& folder) {
  std::vector<Json> cells;
  folder.for_each_cell([&](const Json& cell) { cells.push_back(summary_of(cell)); });
  return cells;
}

void write_benchmark_file(const RunFolder& folder, const Json& manifest) {
  const Json& program = manifest.at("program");
  // The host's name stays out of records; library_build_type is of Google Benchmark alone.
  const Json context{{"host_name", manifest.at("machine").at("id")},
                     {"beambench_run_id", manifest.at("run_id")},
                     {"beambench_commit", program.at("commit")},
                     {"beambench_dirty", program.at("dirty")},
                     {"beambench_build_type", program.at("build_type")},
                     {"beambench_isa", manifest.at("measurement").at("isa")}};
  write_file(folder.path() / "google-benchmark.json", [&](std::ostream& out) {
    write_google_benchmark_json(out, context,
                                [&](const CellVisitor& visit) { folder.for_each_cell(visit); });
  });
}

SweepOutcome conclude(const RunFolder& folder, std::span<const Json> cells,
                      std::vector<std::string> doubts, std::span<const Exclusion> exclude) {
  SweepOutcome outcome{};
  outcome.results = folder.results();
  outcome.cells = cells.size();
  outcome.doubts = std::move(doubts);
  outcome.standings = standings(cells, exclude);
  for (const Json& cell : cells) {
    const auto is = [&](verify::Verdict verdict) {
      return cell.at("row").at("verdict") == verify::to_string(verdict);
    };
    if (is(verify::Verdict::kNoRays)) {
      ++outcome.without_rays;
    } else if (is(verify::Verdict::kUnsupported)) {
      ++outcome.unsupported;
    } else if (!is(verify::Verdict::kOk) && !is(verify::Verdict::kBaseline)) {
      ++outcome.failed;
    }
  }
  outcome.summary = describe(outcome.standings) + "\n" + describe_verdicts(outcome);
  folder.write_text("summary.txt", outcome.summary);
  return outcome;
}

}  // namespace beambench::bench

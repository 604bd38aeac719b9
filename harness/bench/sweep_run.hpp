#pragma once
// Runs a sweep from its plan to its folder.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "harness/bench/config.hpp"
#include "harness/bench/google_benchmark.hpp"
#include "harness/bench/plan.hpp"
#include "harness/bench/record/run_folder.hpp"

namespace beambench::bench {

struct SweepOptions {
  /// Where to; nothing: a new folder in results/runs, named after the run.
  std::optional<std::filesystem::path> folder;
  /// Go on with the run in `folder`.
  bool resume = false;
  BenchmarkFlags flags;
  /// Called with the run's folder as soon as the run can be resumed.
  std::function<void(const std::filesystem::path&)> begun;
  /// Called with the key of a cell when a structure is about to work for it, and with "" when it
  /// has done so.
  std::function<void(std::string_view)> at_work = [](std::string_view) {};
  /// Cells by key that are not to be measured, with the reason: they broke the process down.
  std::map<std::string, std::string> broken_cells{};
};

struct SweepOutcome {
  std::filesystem::path results;  ///< results.csv
  std::size_t cells = 0;          ///< in the record, those of an earlier part of the run included
  std::size_t failed = 0;         ///< of them, wrong or not built
  std::size_t without_rays = 0;   ///< of them, of a kind of rays that their scene has none of
};

/// Measures all cells of `plan` that the folder does not hold yet. Progress, mismatches and notes
/// go to `messages`. Throws InputError when the folder cannot be written, already holds a run, or
/// holds one that cannot go on; a structure's fault is recorded and never thrown.
SweepOutcome run_sweep(const SweepConfig& config, Plan plan, const GoogleBenchmark& benchmark,
                       const SweepOptions& options, std::FILE* messages);

}  // namespace beambench::bench

#pragma once
// Runs a sweep from its plan to its folder.

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>

#include "harness/bench/config.hpp"
#include "harness/bench/google_benchmark.hpp"
#include "harness/bench/plan.hpp"
#include "harness/plugin/activity.hpp"

namespace beambench::bench {

struct SweepOptions {
  /// Where to; nothing: a new folder in results/runs, named after the run.
  std::optional<std::filesystem::path> folder{};
  /// Continue the run in `folder`.
  bool resume = false;
  /// Called with the run's folder as soon as the run can be resumed.
  std::function<void(const std::filesystem::path&)> begun = [](const std::filesystem::path&) {};
  /// Gets the key of the cell that is being measured, for the process that cleans up after a crash.
  /// Cells that crashed an earlier process are recorded and not measured again.
  plugin::Activity* activity = nullptr;
};

struct SweepOutcome {
  std::filesystem::path results;  ///< results.csv
  std::size_t cells = 0;          ///< in the record, those of an earlier part of the run included
  std::size_t failed = 0;         ///< of them, wrong or not built
  std::size_t without_rays = 0;   ///< of them, of a kind of rays that their scene has none of
};

/// Measures all cells of `plan` that the folder does not hold yet. Progress, mismatches and notes
/// go to `messages`. Throws InputError when the folder cannot be written, already holds a run, or
/// holds one that cannot be resumed; a structure's fault is recorded and never thrown.
SweepOutcome run_sweep(const SweepConfig& config, Plan plan, const GoogleBenchmark& benchmark,
                       const SweepOptions& options, std::FILE* messages);

}  // namespace beambench::bench

#pragma once
// Runs a sweep, from its plan to the files in its folder.

#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/measure/config.hpp"
#include "harness/measure/division.hpp"
#include "harness/measure/google_benchmark.hpp"
#include "harness/measure/plan.hpp"

namespace beambench::measure {

struct SweepOptions {
  /// The output folder; nothing: a new folder in results/runs, named after the run.
  std::optional<std::filesystem::path> folder{};
  /// Continues the run in `folder`.
  bool resume = false;
  /// The part of the sweep that the plan covers; nothing: all of it.
  std::optional<PlannedShard> shard{};
  /// Called with the run's folder as soon as the run can be resumed.
  std::function<void(const std::filesystem::path&)> begun = [](const std::filesystem::path&) {};
  /// The program that measures blocks, with its arguments (`measure_in_process`). Empty: this
  /// process measures them, and intervals do not cover the variation between processes.
  std::vector<std::string> block_program{};
  /// Prints a line for each cell even on a terminal, instead of redrawing one line.
  bool line_per_cell = false;
  /// Maximum number of tries of a disturbed repetition.
  int tries = 3;
  /// The folder that contains /proc and the control groups, from which CPU quotas are read.
  std::filesystem::path root = "/";
  /// Called before each view's rays are generated, and before each counting pass and repetition. An
  /// exception ends the run; all repetitions so far are kept.
  std::function<void()> before_each_piece = [] {};
};

/// Measures all cells of `plan` that are not yet in the folder's log, in blocks spread over the run
/// (block.hpp). An unfinished cell continues after its last repetition. Writes only the log
/// (`RunLog`). Progress, mismatches and notes go to `messages`. Returns the folder. Throws
/// InputError if the folder cannot be written, already contains a run, or contains one that cannot
/// be resumed. Errors of structures, even those that end the process of a block, are recorded and
/// never thrown.
std::filesystem::path run_sweep(const SweepConfig& config, Plan plan,
                                const GoogleBenchmark& benchmark, const SweepOptions& options,
                                std::FILE* messages);

}  // namespace beambench::measure

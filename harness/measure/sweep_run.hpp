#pragma once
// Runs a sweep from its plan to its folder.

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
  /// The part of a sweep that the plan is; nothing: all of it.
  std::optional<PlannedShard> shard{};
  /// Called with the run's folder as soon as the run can be resumed.
  std::function<void(const std::filesystem::path&)> begun = [](const std::filesystem::path&) {};
  /// The program that measures blocks, with its arguments (`measure_in_process`); empty: this
  /// process does. Then what differs between processes is in no interval.
  std::vector<std::string> block_program{};
  /// Prints a line for each cell, on a terminal too, in place of one line that is redrawn.
  bool line_per_cell = false;
  /// Maximum number of tries of a repetition that other processes disturb.
  int tries = 3;
  /// The folder that holds /proc and the control groups, from which CPU quotas are read.
  std::filesystem::path root = "/";
  /// Called before each view's rays are made, each counting pass and each repetition. An exception
  /// ends the run; every repetition is kept.
  std::function<void()> before_each_piece = [] {};
};

/// Measures all cells of `plan` that are not in the folder's log yet, in blocks that are spread
/// over the run (block.hpp); an unfinished one continues after its last repetition. Only the log is
/// written (`RunLog`). Progress, mismatches and notes go to `messages`. Returns the folder. Throws
/// InputError when it cannot be written, already holds a run, or holds one that cannot be resumed;
/// a structure's fault, and that it ends the process of a block, is recorded and never thrown.
std::filesystem::path run_sweep(const SweepConfig& config, Plan plan,
                                const GoogleBenchmark& benchmark, const SweepOptions& options,
                                std::FILE* messages);

}  // namespace beambench::measure

#pragma once
// Runs a sweep from its plan to its folder.

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/bench/config.hpp"
#include "harness/bench/google_benchmark.hpp"
#include "harness/bench/plan.hpp"
#include "harness/bench/standings.hpp"
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
  /// Called before each group's rays are made, each counting pass and each repetition. What it
  /// throws ends the run; the finished cells are kept.
  std::function<void()> before_each_piece = [] {};
};

struct SweepOutcome {
  std::filesystem::path results;  ///< results.csv
  std::size_t cells = 0;          ///< in the record, those of an earlier part of the run included
  std::size_t failed = 0;         ///< of them, wrong or not built
  std::size_t without_rays = 0;   ///< of them, of a kind of rays that their scene has none of
  std::vector<std::string> doubts{};  ///< why the times are worth little; clauses
  std::vector<Standings> standings{};
  std::string summary{};  ///< who is fastest, and the verdicts: the text of summary.txt
};

/// Two lines, one on the hits and one on what the times are worth; a third on rays that scenes
/// lack.
std::string describe_verdicts(const SweepOutcome& outcome);

/// A mismatch where hits were wrong; invalid input where no scene had any rays to measure.
int exit_code_of(const SweepOutcome& outcome);

/// Measures all cells of `plan` that the folder does not hold yet. Progress, mismatches and notes
/// go to `messages`; the folder's summary.txt names the fastest and has the verdicts. Throws
/// InputError when the folder cannot be written, already holds a run, or holds one that cannot be
/// resumed; a structure's fault is recorded and never thrown.
SweepOutcome run_sweep(const SweepConfig& config, Plan plan, const GoogleBenchmark& benchmark,
                       const SweepOptions& options, std::FILE* messages);

}  // namespace beambench::bench

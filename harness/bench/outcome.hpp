#pragma once
// What a run comes to: the conclusions from its finished cells.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/bench/config.hpp"
#include "harness/bench/record/run_folder.hpp"
#include "harness/bench/standings.hpp"

namespace beambench::bench {

struct SweepOutcome {
  std::filesystem::path results;  ///< results.csv
  std::size_t cells = 0;          ///< in the record, those of an earlier part of the run included
  std::size_t failed = 0;         ///< of them, wrong or not built
  std::size_t without_rays = 0;   ///< of them, of a kind of rays that their scene has none of
  std::size_t unsupported = 0;  ///< of them, of rays or primitives that the structure does not take
  bool is_part = false;         ///< is the run a shard of a sweep?
  std::vector<std::string> doubts{};  ///< why the times are worth little; clauses
  std::vector<Standings> standings{};
  std::string summary{};  ///< who is fastest, and the verdicts: the text of summary.txt
};

/// Two lines, one on the hits and one on what the times are worth; a third on rays that scenes
/// lack.
std::string describe_verdicts(const SweepOutcome& outcome);

/// A mismatch where hits were wrong; invalid input where no scene of a whole sweep had any rays to
/// measure. A shard may have none.
int exit_code_of(const SweepOutcome& outcome);

/// A cell's file with what standings, overheads and doubts read: a tenth of it.
nlohmann::ordered_json summary_of(const nlohmann::ordered_json& cell);

/// The `summary_of` each cell of a run, in the order of the plan.
std::vector<nlohmann::ordered_json> summaries(const RunFolder& folder);

/// Writes the repetitions of a run as Google Benchmark does; `manifest` is the run's.
void write_benchmark_file(const RunFolder& folder, const nlohmann::ordered_json& manifest);

/// The outcome of a run whose cells have these `summaries`; writes its summary.txt. `doubts` are
/// those about its times, `exclude` the sweep's conditions.
SweepOutcome conclude(const RunFolder& folder, std::span<const nlohmann::ordered_json> cells,
                      std::vector<std::string> doubts, std::span<const Exclusion> exclude);

}  // namespace beambench::bench

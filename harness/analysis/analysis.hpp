#pragma once
// The conclusions from a run: who is fastest, how far times can be trusted, and the harness's own
// share.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/analysis/frames.hpp"
#include "harness/analysis/standings.hpp"
#include "harness/analysis/steadiness.hpp"
#include "harness/measure/record/run_log.hpp"

namespace beambench::analysis {

/// The harness's own share of a trace (`harness_ms`) in the cell where it is the largest part of
/// the contender's time, among those of one query path.
struct Overhead {
  std::string path;   ///< the QueryPath, by name
  std::string cell;   ///< its name
  std::string title;  ///< `samet max_level=5 in escena1 at 640x480`
  double part;        ///< of its median trace time
};

/// The conclusions from a run.
struct Analysis {
  std::size_t cells = 0;         ///< in the record
  std::size_t planned = 0;       ///< of the sweep, or of its shard
  std::size_t failed = 0;        ///< wrong or not built
  std::size_t without_rays = 0;  ///< of a kind of rays that their scene has none of
  std::size_t unsupported = 0;   ///< of rays or primitives the structure does not take

  /// Returns the number of cells that could be measured.
  std::size_t possible() const { return cells - without_rays - unsupported; }

  bool is_part = false;                       ///< is the run a shard of a sweep?
  std::vector<std::string> reasons_for_care;  ///< why the times are worth little; clauses
  std::optional<Steadiness> steadiness;       ///< of the machine; nothing for few blocks
  std::vector<Standings> views;
  std::vector<OverallStandings> means;
  std::vector<Overhead> overheads;  ///< the largest first
  std::vector<BlockTotals> block_totals;
  std::vector<FrameSeries> frame_series;  ///< of scenes that move
};

/// Draws the conclusions from a run, which may have been cut off. Depends on nothing else.
Analysis analyze(const measure::Run& run);

/// Returns one for each path with correct hits, the largest first. Structures that trace images by
/// samples of their own have none, nor do whole pictures, which include shading by design.
std::vector<Overhead> largest_overheads(const measure::Run& run);

/// Returns why the times of a run cannot be fully trusted: an unsteady machine, noise of equal
/// work, other work (a load average), a CPU quota, missed precision, too few repetitions for an
/// interval. Each is a clause; nothing speaks against the times if there are none.
std::vector<std::string> reasons_for_care(const measure::Run& run);

/// Returns the code for a mismatch if hits were wrong, or for invalid input if no scene of a whole
/// sweep had any rays to measure. A shard may have none.
int exit_code_of(const Analysis& analysis);

/// Returns the text of analysis.json.
nlohmann::ordered_json to_json(const Analysis& analysis);

}  // namespace beambench::analysis

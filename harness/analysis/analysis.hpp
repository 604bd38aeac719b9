#pragma once
// The conclusions from a run: who is fastest, how far the times can be trusted, and the harness's
// own share.

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

/// The harness's own time (`harness_ms`) on one query path, in the cell in which it is the largest
/// fraction of the contender's trace time.
struct Overhead {
  std::string path;   ///< the QueryPath, by name
  std::string cell;   ///< name of the cell
  std::string title;  ///< `samet max_level=5 in escena1 at 640x480`
  double part;        ///< fraction of the contender's median trace time
};

/// The conclusions from a run.
struct Analysis {
  std::size_t cells = 0;         ///< number of cells in the record
  std::size_t planned = 0;       ///< number of cells in the sweep, or in its shard
  std::size_t failed = 0;        ///< cells with wrong hits, or not built
  std::size_t without_rays = 0;  ///< cells for which the scene has no rays of the kind
  std::size_t unsupported = 0;   ///< the structure does not support the rays or primitives

  /// Returns the number of cells that could be measured.
  std::size_t possible() const { return cells - without_rays - unsupported; }

  bool is_part = false;                       ///< whether the run is a shard of a sweep
  std::vector<std::string> reasons_for_care;  ///< why the times cannot be fully trusted; clauses
  std::optional<Steadiness> steadiness;       ///< nothing if there are too few blocks
  std::vector<Standings> views;
  std::vector<OverallStandings> means;
  std::vector<Overhead> overheads;  ///< the largest first
  std::vector<BlockTotals> block_totals;
  std::vector<FrameSeries> frame_series;  ///< of animated scenes
};

/// Draws the conclusions from a run, which may have been cut off. Depends only on the run.
Analysis analyze(const measure::Run& run);

/// Returns the largest overhead of each query path, the largest first, among cells with correct
/// hits. Structures that sample images themselves have no overhead, and neither do whole pictures,
/// which include shading by design.
std::vector<Overhead> largest_overheads(const measure::Run& run);

/// Returns why the times of a run cannot be fully trusted: an unsteady machine, noise of equal
/// work, other work, a CPU quota, missed precision, too few repetitions for an
/// interval. Each reason is a clause; if there are none, the times can be trusted.
std::vector<std::string> reasons_for_care(const measure::Run& run);

/// Returns the exit code: mismatch if hits were wrong, invalid input if no cell of a whole sweep
/// could be measured. A shard may have no such cell.
int exit_code_of(const Analysis& analysis);

/// Returns the text of analysis.json.
nlohmann::ordered_json to_json(const Analysis& analysis);

}  // namespace beambench::analysis

#pragma once
// Standings: who is fastest, and by how much, in each view and over all views of one kind of rays.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/analysis/names.hpp"
#include "harness/analysis/ratio.hpp"
#include "harness/measure/record/block_statistics.hpp"
#include "harness/measure/record/run_log.hpp"

namespace beambench::analysis {

/// Times that differ by less than this are equivalent.
inline constexpr double kMargin = 0.03;

/// The rank of a contender, by the confidence interval of its ratio to the fastest.
enum class Rank {
  kTied,       ///< the fastest, or equivalent to it: the interval ends within the margin
  kBehind,     ///< clearly slower: the interval begins above 1, and ends beyond the margin
  kUndecided,  ///< the interval contains 1 and ends beyond the margin
  kUnranked    ///< there is no interval
};
/// Returns the name. In records without blocks, whose intervals cover one process only, contenders
/// whose interval contains 1 are tied and the others are behind, by the rule in force when they
/// were measured.
std::string_view to_string(Rank rank);  // "tied", "behind", "undecided", "unranked"

/// One contender in one view.
struct Standing {
  std::string contender;  ///< the structure, with the parameters in which its variants differ
  std::string structure;  ///< the bare name
  std::string variant;    ///< if tuned: `embree:mode=stream,robust=false`; otherwise empty
  std::string isa;        ///< the instruction set of its SIMD code; empty: no SIMD
  bool self_reported;     ///< whether its times are those of a program's own clock
  double build_ms;        ///< fastest build (or update); the median in records without blocks
  double ns_per_ray;      ///< first trace after a build; the median in records without blocks
  TimeRatio ratio;        ///< its trace time divided by that of the fastest

  /// Returns the contender; if it is tuned, with its variant.
  std::string name() const;
  Rank rank() const;
  bool is_tied() const { return rank() == Rank::kTied; }
};

/// A contender without a time in a view, and the reason as a clause.
struct LeftOut {
  std::string contender;
  std::string reason;
};

/// All contenders of one view (scene, camera, samples, kind of rays), at the highest resolution at
/// which one machine measured at least two of them, since a run that was cut off may have only one
/// at its last resolution. Times of different machines are not compared.
struct Standings {
  /// The scene; also the camera, samples, kind of rays and machine if they vary within the run.
  std::string view;
  std::string subject;  ///< the view without the machine
  std::string size;     ///< `1280x1024`
  std::string ray_kind;
  std::uint64_t rays;
  std::vector<Standing> ranked;      ///< the fastest first; empty if no hits were correct
  std::vector<Standing> references;  ///< `null`, which finds nothing; `exhaustive`, which tests all
  std::vector<LeftOut> left_out;
  int unrecorded = 0;  ///< number of entries of `left_out` that are in the sweep but have no row
  /// Whether fewer than 1% of its closest-hit rays hit, or fewer than 1% or more than 99% of its
  /// any-hit rays are occluded.
  bool is_degenerate = false;
  bool in_means = false;  ///< whether means include the view; degenerate views are excluded

  measure::TraceClock clock = measure::TraceClock::kWall;  ///< the clock used for comparison

  /// Returns the first contender that is clearly slower than the fastest; null if there is none.
  const Standing* behind() const;
  /// Returns Embree's fastest mode; null if Embree is not ranked.
  const Standing* embree() const;
  /// Returns the number of rays at which the total time of the fastest, build included, beats all
  /// contenders behind it: the additional build time divided by the time saved per ray. 0: from the
  /// first ray; infinite: never; nothing: no contender is behind it.
  std::optional<double> break_even_rays() const;
  /// Returns the contender that determines `break_even_rays`; null if there is none.
  const Standing* last_overtaken() const;
};

/// A contender's result over all views of one kind of rays.
struct MeanStanding {
  std::string contender;
  std::string structure;
  TimeRatio ratio;                  ///< geometric mean of its ratios to the fastest of each view
  std::optional<Interval> scatter;  ///< interval of that mean, from the scatter between views
  int views;                        ///< number of views in which it has a time
  int wins;                         ///< number of views in which it is the fastest, or tied with it
};

struct OverallStandings {
  std::string ray_kind;
  int views;
  std::vector<MeanStanding> means;  ///< those with times in every view first, then by ratio
  std::vector<MeanStanding> references;
};

/// Returns the indices of the cells of tuned contenders that are slower in their view than another
/// parameter set of the same contender: two sets are measured, and the faster one with correct hits
/// represents the contender.
std::set<std::size_t> outpaced_sets(const measure::Run& run);

/// Returns the names of each cell of a run.
std::vector<Names> names_of(const measure::Run& run);

/// Returns whether a cell was measured in blocks.
bool has_blocks(const measure::CellRecord& cell);

/// Returns the trace time of a cell by a clock, or by the cell's own clock (`measure::own_clock`):
/// the mean over its blocks, with both intervals. In a record without blocks: the median of its
/// repetitions with an interval, or the recorded figure. Returns nothing if its hits are not
/// correct.
std::optional<measure::Estimate> trace_time(
    const measure::CellRecord& cell, std::optional<measure::TraceClock> clock = std::nullopt);

/// Returns the total time of build and trace of a cell, in the same way.
std::optional<measure::Estimate> total_time(const measure::CellRecord& cell);

/// The total time of build and trace of a cell in each block.
struct BlockTotals {
  std::string cell;           ///< its name
  measure::TraceClock clock;  ///< the clock of all cells with these rays
  TimesByBlock ms;
};

/// Returns the totals of each cell that was measured in blocks and has times, in the order of the
/// run.
std::vector<BlockTotals> block_totals(const measure::Run& run);

/// Returns the standings of each view, in the order of the plan. The sweep's `exclude` conditions
/// explain absent contenders.
std::vector<Standings> standings(const measure::Run& run);

/// Returns the means over the views of each kind of rays. If several machines measured a view, one
/// at each resolution, the highest resolution counts.
std::vector<OverallStandings> overall(std::span<const Standings> views);

}  // namespace beambench::analysis

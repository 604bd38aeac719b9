#pragma once
// Who is fastest: in each view, by how much, and over all views of one kind of rays.

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

/// Times that differ by less are equivalent.
inline constexpr double kMargin = 0.03;

/// The rank of a contender, by the confidence interval of its ratio to the fastest.
enum class Rank {
  kTied,       ///< the fastest, or equivalent to it: the interval ends within the margin
  kBehind,     ///< clearly slower: the interval begins above 1, and ends beyond the margin
  kUndecided,  ///< the interval contains 1 and ends beyond the margin
  kUnranked    ///< there is no interval
};
/// Returns the name. In records without blocks, whose intervals are of one process, contenders
/// whose interval contains 1 are tied and the others behind, as when they were measured.
std::string_view to_string(Rank rank);  // "tied", "behind", "undecided", "unranked"

/// One contender in one view.
struct Standing {
  std::string contender;  ///< the structure, with the parameters by which its variants differ
  std::string structure;  ///< the bare name
  std::string variant;    ///< of a tuned contender: `embree:mode=stream,robust=false`; else empty
  std::string isa;        ///< the instruction set of its SIMD code; empty: it has none
  double build_ms;        ///< or of its update: the fastest; in records without blocks the median
  double ns_per_ray;  ///< of the first trace after a build; in records without blocks the median
  TimeRatio ratio;    ///< its trace time over that of the fastest

  /// Returns the contender; where it is tuned, with its variant.
  std::string name() const;
  Rank rank() const;
  bool is_tied() const { return rank() == Rank::kTied; }
};

/// A contender without a time in a view, and the reason in a clause.
struct LeftOut {
  std::string contender;
  std::string reason;
};

/// All contenders of one view (scene, camera, samples, kind of rays) at the highest resolution at
/// which one machine measured two of them: a run that was cut off may have one contender at its
/// last resolution. Times of two machines are not compared.
struct Standings {
  /// The scene, with camera, samples, kind of rays and machine where a run has several.
  std::string view;
  std::string subject;  ///< the same without the machine
  std::string size;     ///< `1280x1024`
  std::string ray_kind;
  std::uint64_t rays;
  std::vector<Standing> ranked;      ///< the fastest first; empty where no hits were correct
  std::vector<Standing> references;  ///< `null`, which finds nothing; `exhaustive`, which tests all
  std::vector<LeftOut> left_out;
  int unrecorded = 0;  ///< of `left_out`: without a row, but in the sweep
  /// Do fewer than 1% of its closest-hit rays hit, or are fewer than 1% or more than 99% of its
  /// any-hit rays occluded?
  bool is_degenerate = false;
  bool in_means = false;  ///< is it among the views that means are over? Degenerate ones are not

  measure::TraceClock clock = measure::TraceClock::kWall;  ///< by which all are compared

  /// Returns the first that is clearly slower than the fastest; null where there is none.
  const Standing* behind() const;
  /// Returns Embree's fastest mode; null where there is none.
  const Standing* embree() const;
  /// Returns the number of rays from which the fastest, build included, is ahead of all that are
  /// behind it: the additional build time over the time saved per ray. 0: from the first;
  /// infinite: never; nothing: none is behind it.
  std::optional<double> break_even_rays() const;
  /// Returns the contender that determines `break_even_rays`; null where there is none.
  const Standing* last_overtaken() const;
};

/// A contender, over all views of one kind of rays.
struct MeanStanding {
  std::string contender;
  std::string structure;
  TimeRatio ratio;                  ///< geometric mean of its ratios to the fastest of each view
  std::optional<Interval> scatter;  ///< of that mean, by the scatter between the views
  int views;                        ///< in which it has a time
  int wins;                         ///< in which it is the fastest, or tied with it
};

struct OverallStandings {
  std::string ray_kind;
  int views;
  std::vector<MeanStanding> means;  ///< those with times in every view first, the fastest ahead
  std::vector<MeanStanding> references;
};

/// Returns the indices of the cells of tuned contenders that others of the same contender outpace
/// in their view: two are measured, and the faster one with correct hits stands for the contender.
std::set<std::size_t> outpaced_sets(const measure::Run& run);

/// Returns the names of each cell of a run.
std::vector<Names> names_of(const measure::Run& run);

/// Returns whether the repetitions of a cell were made in blocks.
bool has_blocks(const measure::CellRecord& cell);

/// Returns the trace time of a cell by a clock, or by its own (`measure::own_clock`): the mean over
/// its blocks with both intervals. In a record without blocks, the median of its repetitions with
/// its interval, or as it was summed up. Nothing where its hits are not correct.
std::optional<measure::Estimate> trace_time(
    const measure::CellRecord& cell, std::optional<measure::TraceClock> clock = std::nullopt);

/// Returns the time of building and tracing of a cell, likewise.
std::optional<measure::Estimate> total_time(const measure::CellRecord& cell);

/// The time of building and tracing of a cell in each block.
struct BlockTotals {
  std::string cell;           ///< its name
  measure::TraceClock clock;  ///< that of all cells with these rays
  TimesByBlock ms;
};

/// Returns those of each cell that was measured in blocks and has times, in the order of the run.
std::vector<BlockTotals> block_totals(const measure::Run& run);

/// Returns the standings of each view, in the order of the plan. The conditions of the sweep
/// explain why a contender is absent.
std::vector<Standings> standings(const measure::Run& run);

/// The means over the views of each kind of rays. Where several machines measured a view, one at
/// each resolution, the highest resolution counts.
std::vector<OverallStandings> overall(std::span<const Standings> views);

}  // namespace beambench::analysis

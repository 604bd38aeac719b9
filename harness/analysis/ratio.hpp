#pragma once
// The ratio of two times with its intervals, and the break-even point of two contenders; computed
// only here.
//
// The contenders of a view are measured together in blocks, each a separate process. Whatever slows
// down a process or a moment affects both times of a block, so their ratio has less noise than
// either time. A ratio is therefore computed block by block, from the fastest undisturbed
// repetition of each contender, and its logarithm is averaged over the blocks, with the intervals
// of `measure::estimate`. Records of one process have no blocks: there the ratio is the median of
// the rounds' ratios, with the 95% interval of that median. If only medians and their intervals are
// known, the ratio is not paired, and its interval is wider than necessary. Overlapping intervals
// of two times decide nothing: their ratio may still be clearly different from 1.

#include <map>
#include <optional>
#include <span>

#include "harness/measure/record/robust_statistics.hpp"

namespace beambench::analysis {

using measure::Interval;

/// The ratio of one time to another, with a 95% confidence interval if there are enough blocks or
/// repetitions.
struct TimeRatio {
  double value = 1.0;
  std::optional<Interval> interval{};
  bool is_paired = false;  ///< whether it was computed per block or per round
  /// Covers the ratio of a second run of equal size with 95% probability; only with blocks.
  std::optional<Interval> prediction{};
  std::optional<double> error{};  ///< standard error of its logarithm; only with blocks
};

/// A median with its 95% interval.
struct Median {
  double value;
  std::optional<Interval> interval{};
};

/// Times by the rounds in which they were measured.
using TimesByRound = std::map<int, double>;
/// Times by blocks: the value of each (`measure::trace_by_block`).
using TimesByBlock = std::map<int, double>;

/// Returns the geometric mean of the ratios of the blocks that both contenders have, with its
/// intervals (`measure::estimate`); nothing if they have no common block.
std::optional<TimeRatio> block_ratio(const TimesByBlock& over, const TimesByBlock& under);

/// Returns the median ratio of the rounds that both contenders have; nothing if they have no common
/// round.
std::optional<TimeRatio> paired_ratio(const TimesByRound& over, const TimesByRound& under);

/// Returns the ratio of two medians. It has an interval if both medians have one: the distances
/// from the medians to the interval ends add up in quadrature on a logarithmic scale (Zou and
/// Donner, Statistics in Medicine 27, 2008).
TimeRatio unpaired_ratio(const Median& over, const Median& under);

/// Returns the geometric mean of at least one ratio. The mean has an interval if all ratios have
/// one: views are measured one after another, so their noise is independent, and the distances to
/// the interval ends add up in quadrature. This interval covers measurement noise only; for the
/// variation between views, see `scatter`.
TimeRatio geometric_mean(std::span<const TimeRatio> ratios);

/// Returns the 95% confidence interval of a geometric mean over views regarded as a random sample,
/// from the scatter between them; nothing for fewer than two.
std::optional<Interval> scatter(std::span<const TimeRatio> ratios);

/// A contender's build time and its time per ray.
struct Cost {
  double build_ms;
  double ns_per_ray;
};

/// Returns the number of rays at which one contender's total time, build included, beats another's:
/// the additional build time divided by the time saved per ray. 0: from the first ray; infinite:
/// never, or only up to some number of rays.
double break_even_rays(const Cost& mine, const Cost& other);

}  // namespace beambench::analysis

#pragma once
// The ratio of two times with its intervals, and the break-even of two contenders: the only place
// where they are computed.
//
// The contenders of a view are measured together in blocks, each a process of its own, so what
// slows a process or a moment down is in both times of a block, and their ratio has less noise than
// either. A ratio is therefore made block by block, from the fastest undisturbed repetition of
// each, and averaged over the blocks as a logarithm, with the intervals of `measure::estimate`.
// Records of one process have no blocks: there the ratio is the median of the rounds' ratios, with
// the 95% interval of that median. Where only medians and their intervals are known, the ratio is
// not paired, and its interval is wider than necessary. Whether two intervals overlap decides
// nothing: the ratio of two times with overlapping intervals may be clearly off 1.

#include <map>
#include <optional>
#include <span>

#include "harness/measure/record/robust_statistics.hpp"

namespace beambench::analysis {

using measure::Interval;

/// The ratio of one time to another, with a 95% confidence interval where there are enough blocks
/// or repetitions.
struct TimeRatio {
  double value = 1.0;
  std::optional<Interval> interval{};
  bool is_paired = false;  ///< was it made block by block, or round by round?
  /// Where a second run of equal size is expected with 95%; only with blocks.
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

/// Returns the geometric mean of the ratios of the blocks that both have, with its
/// intervals (`measure::estimate`); nothing where they have no block in common.
std::optional<TimeRatio> block_ratio(const TimesByBlock& over, const TimesByBlock& under);

/// Returns the median ratio of the rounds that both have; nothing where they have no round in
/// common.
std::optional<TimeRatio> paired_ratio(const TimesByRound& over, const TimesByRound& under);

/// Returns the ratio of two medians. It has an interval where both have one: their distances to the
/// ends add up in quadrature on a logarithmic scale (Zou and Donner, Statistics in Medicine 27,
/// 2008).
TimeRatio unpaired_ratio(const Median& over, const Median& under);

/// Returns the geometric mean of at least one ratio. It has an interval where all have one: views
/// are measured one after another, so their noise is independent, and the distances to their ends
/// add up in quadrature. That is the noise of measuring; see `scatter` for that of the views.
TimeRatio geometric_mean(std::span<const TimeRatio> ratios);

/// Returns the 95% confidence interval of a geometric mean as one over views drawn at random: from
/// the scatter between them. None for fewer than two.
std::optional<Interval> scatter(std::span<const TimeRatio> ratios);

/// The time that a contender takes to build, and for each ray.
struct Cost {
  double build_ms;
  double ns_per_ray;
};

/// Returns the number of rays from which one contender, its build included, is ahead of another:
/// the additional build time over the time saved per ray. 0: from the first; infinite: never, or
/// only up to some number of rays.
double break_even_rays(const Cost& mine, const Cost& other);

}  // namespace beambench::analysis

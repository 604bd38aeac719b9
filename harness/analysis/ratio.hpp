#pragma once
// The ratio of two times with its interval, and the break-even of two contenders: the only place
// where they are computed.
//
// Contenders of a run take turns, so the repetitions of one round ran side by side: a slow moment
// of the machine is in both of them, and their ratio has less noise than either. Where both have
// their repetitions, the ratio is therefore paired: the median of the rounds' ratios, with the 95%
// interval of that median (`measure::median_interval`). Where only medians and their intervals are
// known, the ratio is not paired, and its interval is wider than necessary. Whether two intervals
// overlap decides nothing: the ratio of two times with overlapping intervals may be clearly off 1.

#include <map>
#include <optional>
#include <span>

#include "harness/measure/record/robust_statistics.hpp"

namespace beambench::analysis {

using measure::Interval;

/// The ratio of one time to another, with a 95% interval where there are enough repetitions.
struct TimeRatio {
  double value = 1.0;
  std::optional<Interval> interval{};
  bool is_paired = false;  ///< was it made round by round?
};

/// A median with its 95% interval.
struct Median {
  double value;
  std::optional<Interval> interval{};
};

/// Times by the rounds in which they were measured.
using TimesByRound = std::map<int, double>;

/// Returns the median ratio of the rounds that both have; nothing where they have no round in
/// common.
std::optional<TimeRatio> paired_ratio(const TimesByRound& over, const TimesByRound& under);

/// Returns the ratio of two medians. It has an interval where both have one: their distances to the
/// ends add up in quadrature on a logarithmic scale (Zou and Donner, Statistics in Medicine 27,
/// 2008).
TimeRatio unpaired_ratio(const Median& over, const Median& under);

/// Returns the geometric mean of at least one ratio. It has an interval where all have one: views
/// are measured one after another, so their noise is independent, and the distances to their ends
/// add up in quadrature.
TimeRatio geometric_mean(std::span<const TimeRatio> ratios);

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

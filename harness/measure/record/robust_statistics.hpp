#pragma once
// Statistics that are robust against a few disturbed repetitions.

#include <optional>
#include <span>

namespace beambench::measure {

struct Interval {
  double low;
  double high;
};

/// Returns the middle value, or the mean of the two middle ones. `samples` must not be empty.
double median(std::span<const double> samples);

/// Returns the smallest value, from the least disturbed repetition. `samples` must not be empty.
double minimum(std::span<const double> samples);

/// Returns the median distance from the median (MAD), not scaled to the standard deviation of a
/// normal distribution.
double median_absolute_deviation(std::span<const double> samples);

/// Returns an interval that covers the true median with at least 95% probability, whatever the
/// distribution. Its ends are two order statistics whose ranks follow from the binomial
/// distribution with p = 1/2 (Conover, Practical Nonparametric Statistics, section 3.2). Returns
/// nothing for fewer than six samples: even the interval between their extremes covers the median
/// with a lower probability.
std::optional<Interval> median_interval(std::span<const double> samples);

/// Returns a bound that holds with at least 95% probability: the distance between the smallest of
/// these samples and the smallest of as many further samples. The bound is the distance to the k-th
/// smallest sample, where k is the least rank with P(new smallest > k-th) <= 2.5%; k is 5 for 6 to
/// 24 samples. The bound on a larger new smallest sample holds whatever the distribution. The new
/// smallest sample lies further below than this distance with the same probability, 2^-k for many
/// samples, if the density is constant near the lower end (the assumption of Robson and Whitlock,
/// Estimation of a truncation point, Biometrika 51, 1964). Returns nothing for fewer than four
/// samples.
std::optional<double> repeat_spread_of_minimum(std::span<const double> samples);

}  // namespace beambench::measure

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

/// Returns the smallest value: that of the least disturbed repetition. `samples` must not be empty.
double minimum(std::span<const double> samples);

/// Returns the median distance from the median (MAD), not scaled to the standard deviation of a
/// normal distribution.
double median_absolute_deviation(std::span<const double> samples);

/// Returns an interval that covers the true median with at least 95% probability, whatever the
/// distribution. Its ends are two order statistics whose ranks follow from the binomial
/// distribution with p = 1/2 (Conover, Practical Nonparametric Statistics, section 3.2). Returns
/// nothing for fewer than six samples, whose extremes cover it with less.
std::optional<Interval> median_interval(std::span<const double> samples);

/// Returns the maximum distance between the smallest of as many further samples and the smallest of
/// these, with at least 95% probability. This is the distance to the k-th smallest sample, where k
/// is the least rank with P(new smallest > k-th) <= 2.5%; it is 5 for 6 to 24 samples. That bound
/// holds whatever the distribution. The new smallest lies further below than this distance with the
/// same probability, 2^-k for many samples, if the density is constant near the lower end (the
/// assumption of Robson and Whitlock, Estimation of a truncation point, Biometrika 51, 1964).
/// Returns nothing for fewer than four samples.
std::optional<double> repeat_spread_of_minimum(std::span<const double> samples);

}  // namespace beambench::measure

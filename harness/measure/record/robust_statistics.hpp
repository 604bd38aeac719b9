#pragma once
// Statistics that a few disturbed repetitions cannot move.

#include <optional>
#include <span>

namespace beambench::measure {

struct Interval {
  double low;
  double high;
};

/// Returns the middle value, or the mean of the two middle ones. `samples` is not empty.
double median(std::span<const double> samples);

/// Returns the smallest value: the repetition that was disturbed least. `samples` is not empty.
double minimum(std::span<const double> samples);

/// Returns the median distance from the median (MAD), not scaled to a normal distribution's
/// deviation.
double median_absolute_deviation(std::span<const double> samples);

/// Returns an interval that covers the true median with at least 95%, whatever the distribution:
/// two order statistics whose ranks follow from the binomial distribution with p = 1/2 (Conover,
/// Practical Nonparametric Statistics, section 3.2). None for fewer than six samples, whose
/// extremes cover less.
std::optional<Interval> median_interval(std::span<const double> samples);

/// Returns the maximum distance between the smallest of as many further samples and the smallest of
/// these, with at least 95%: the distance to the k-th smallest, where k is the least rank with P(a
/// further smallest > the k-th) <= 2.5%, five for six to twenty-four samples. That bound holds
/// whatever the distribution; a further smallest is at most as far below with the same probability,
/// 2^-k for many samples, if the density is constant near the lower end (the assumption of Robson
/// and Whitlock, Estimation of a truncation point, Biometrika 51, 1964). None for fewer than four
/// samples.
std::optional<double> repeat_spread_of_minimum(std::span<const double> samples);

}  // namespace beambench::measure

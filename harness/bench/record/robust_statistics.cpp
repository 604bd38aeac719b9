#include "harness/bench/record/robust_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace beambench::bench {
namespace {

constexpr double kTail = 0.025;  // of a 95% interval, on each side

std::vector<double> sorted(std::span<const double> samples) {
  std::vector<double> values(samples.begin(), samples.end());
  std::sort(values.begin(), values.end());
  return values;
}

/// How many of the smallest (and of the largest) of n samples lie outside the interval: the
/// largest k with P(B(n, 1/2) < k) <= kTail.
std::size_t samples_outside(std::size_t n) {
  const auto count = static_cast<double>(n);
  double cumulative = 0.0;
  std::size_t k = 0;
  while (k < n) {
    const auto chosen = static_cast<double>(k);
    const double log_probability = std::lgamma(count + 1.0) - std::lgamma(chosen + 1.0) -
                                   std::lgamma(count - chosen + 1.0) - count * std::log(2.0);
    cumulative += std::exp(log_probability);
    if (cumulative > kTail) break;
    ++k;
  }
  return k;
}

double log_choose(double n, double k) {
  return std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0);
}

/// The same for the interval of a repeat: the largest r with P(Y < X_r) <= kTail, where Y is the
/// (lower) median of n further samples and X_r the r-th smallest of the first n.
std::size_t samples_outside_repeat(std::size_t n) {
  const auto count = static_cast<double>(n);
  const auto middle = static_cast<double>((n + 1) / 2);
  double cumulative = 0.0;
  std::size_t r = 0;
  while (r < n) {
    const auto below = static_cast<double>(r);  // of the first samples, below Y
    cumulative += std::exp(log_choose(middle - 1.0 + below, below) +
                           log_choose(2.0 * count - middle - below, count - below) -
                           log_choose(2.0 * count, count));
    if (cumulative > kTail) break;
    ++r;
  }
  return r;
}

std::optional<Interval> between_order_statistics(std::span<const double> samples,
                                                 std::size_t outside) {
  if (outside == 0) return std::nullopt;
  const std::vector<double> values = sorted(samples);
  return Interval{values[outside - 1], values[values.size() - outside]};
}

}  // namespace

double median(std::span<const double> samples) {
  const std::vector<double> values = sorted(samples);
  const std::size_t middle = values.size() / 2;
  if (values.size() % 2 == 1) return values[middle];
  return 0.5 * (values[middle - 1] + values[middle]);
}

double minimum(std::span<const double> samples) {
  return *std::min_element(samples.begin(), samples.end());
}

double median_absolute_deviation(std::span<const double> samples) {
  const double center = median(samples);
  std::vector<double> distances;
  distances.reserve(samples.size());
  for (const double sample : samples) distances.push_back(std::abs(sample - center));
  return median(distances);
}

std::optional<Interval> median_interval(std::span<const double> samples) {
  return between_order_statistics(samples, samples_outside(samples.size()));
}

std::optional<Interval> repeat_interval(std::span<const double> samples) {
  return between_order_statistics(samples, samples_outside_repeat(samples.size()));
}

}  // namespace beambench::bench

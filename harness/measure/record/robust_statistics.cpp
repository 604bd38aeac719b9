#include "harness/measure/record/robust_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace beambench::measure {
namespace {

constexpr double kTail = 0.025;  // on each side of a 95% interval

std::vector<double> sorted(std::span<const double> samples) {
  std::vector<double> values(samples.begin(), samples.end());
  std::sort(values.begin(), values.end());
  return values;
}

double log_choose(double n, double k) {
  return std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0);
}

/// Returns how many of the smallest (and of the largest) of n samples lie outside the interval: the
/// largest k with P(B(n, 1/2) < k) <= kTail.
std::size_t samples_outside(std::size_t n) {
  const auto count = static_cast<double>(n);
  double cumulative = 0.0;
  std::size_t k = 0;
  while (k < n) {
    cumulative += std::exp(log_choose(count, static_cast<double>(k)) - count * std::log(2.0));
    if (cumulative > kTail) break;
    ++k;
  }
  return k;
}

/// Returns the least k with P(smallest of n further samples > k-th smallest of n) <= kTail: this
/// happens when the k smallest of all 2n samples are among the first n. Returns nothing if there is
/// no such rank.
std::optional<std::size_t> rank_above_next_minimum(std::size_t n) {
  double probability = 1.0;
  for (std::size_t k = 1; k <= n; ++k) {
    probability *= static_cast<double>(n - k + 1) / static_cast<double>(2 * n - k + 1);
    if (probability <= kTail) return k;
  }
  return std::nullopt;
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
  const std::size_t outside = samples_outside(samples.size());
  if (outside == 0) return std::nullopt;
  const std::vector<double> values = sorted(samples);
  return Interval{values[outside - 1], values[values.size() - outside]};
}

std::optional<double> repeat_spread_of_minimum(std::span<const double> samples) {
  const std::optional<std::size_t> rank = rank_above_next_minimum(samples.size());
  if (!rank) return std::nullopt;
  const std::vector<double> values = sorted(samples);
  return values[*rank - 1] - values.front();
}

}  // namespace beambench::measure

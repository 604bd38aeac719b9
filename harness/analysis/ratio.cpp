#include "harness/analysis/ratio.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "harness/measure/record/block_statistics.hpp"

namespace beambench::analysis {

namespace {

/// Returns the ratios for the keys (blocks or rounds) that both maps have.
std::vector<double> common_ratios(const std::map<int, double>& over,
                                  const std::map<int, double>& under) {
  std::vector<double> ratios;
  for (const auto& [turn, time] : over) {
    const auto divisor = under.find(turn);
    if (divisor != under.end() && divisor->second > 0.0) ratios.push_back(time / divisor->second);
  }
  return ratios;
}

}  // namespace

std::optional<TimeRatio> block_ratio(const TimesByBlock& over, const TimesByBlock& under) {
  const std::vector<double> ratios = common_ratios(over, under);
  if (ratios.empty()) return std::nullopt;
  const measure::Estimate mean = measure::estimate(ratios);
  return TimeRatio{mean.value, mean.confidence, true, mean.prediction, mean.error};
}

std::optional<TimeRatio> paired_ratio(const TimesByRound& over, const TimesByRound& under) {
  const std::vector<double> ratios = common_ratios(over, under);
  if (ratios.empty()) return std::nullopt;
  return TimeRatio{measure::median(ratios), measure::median_interval(ratios), true};
}

TimeRatio unpaired_ratio(const Median& over, const Median& under) {
  const double a = over.value, b = under.value;
  TimeRatio ratio{a / b};
  if (over.interval && under.interval && over.interval->low > 0.0 && under.interval->low > 0.0) {
    const double down = std::hypot(std::log(a / over.interval->low),  //
                                   std::log(under.interval->high / b));
    const double up = std::hypot(std::log(over.interval->high / a),  //
                                 std::log(b / under.interval->low));
    ratio.interval = Interval{ratio.value * std::exp(-down), ratio.value * std::exp(up)};
  }
  return ratio;
}

TimeRatio geometric_mean(std::span<const TimeRatio> ratios) {
  double sum = 0.0, down = 0.0, up = 0.0;
  bool known = true;
  bool all_paired = true;
  for (const TimeRatio& one : ratios) {
    all_paired = all_paired && one.is_paired;
    const double value = std::log(one.value);
    sum += value;
    known = known && one.interval && one.interval->low > 0.0;
    if (!known) continue;
    down = std::hypot(down, value - std::log(one.interval->low));
    up = std::hypot(up, std::log(one.interval->high) - value);
  }
  const auto count = static_cast<double>(ratios.size());
  const double mean = sum / count;
  TimeRatio ratio{std::exp(mean), std::nullopt, all_paired};
  if (known) ratio.interval = Interval{std::exp(mean - down / count), std::exp(mean + up / count)};
  return ratio;
}

std::optional<Interval> scatter(std::span<const TimeRatio> ratios) {
  std::vector<double> values;
  for (const TimeRatio& one : ratios) values.push_back(one.value);
  return measure::estimate(values).confidence;
}

double break_even_rays(const Cost& mine, const Cost& other) {
  const double dearer_ns = 1e6 * (mine.build_ms - other.build_ms);
  const double saved_ns = other.ns_per_ray - mine.ns_per_ray;
  if (dearer_ns <= 0.0 && saved_ns >= 0.0) return 0.0;
  return saved_ns > 0.0 ? dearer_ns / saved_ns : std::numeric_limits<double>::infinity();
}

}  // namespace beambench::analysis

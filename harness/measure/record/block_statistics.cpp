#include "harness/measure/record/block_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include <boost/math/distributions/students_t.hpp>

namespace beambench::measure {
namespace {

struct MeanAndDeviation {
  double mean;
  double deviation;  ///< with divisor n - 1
};

/// Returns the mean and deviation of the logarithms of at least one value.
MeanAndDeviation of_logarithms(std::span<const double> values) {
  const auto count = static_cast<double>(values.size());
  double sum = 0.0, squares = 0.0;
  for (const double value : values) sum += std::log(value);
  const double mean = sum / count;
  for (const double value : values) squares += std::pow(std::log(value) - mean, 2);
  return {mean, values.size() > 1 ? std::sqrt(squares / (count - 1.0)) : 0.0};
}

/// Returns the least positive value of each block. Values that are not positive are disturbed,
/// missing or below the clock's resolution.
template <class Figure>
std::map<int, double> least(const CellRecord& cell, Figure figure) {
  std::map<int, double> found;
  for (const Repetition& one : cell.repetitions) {
    const double value = std::invoke(figure, one);
    if (value <= 0.0) continue;
    const auto [place, is_new] = found.emplace(one.block, value);
    if (!is_new) place->second = std::min(place->second, value);
  }
  return found;
}

Interval around(double mean, double half_width) {
  return {std::exp(mean - half_width), std::exp(mean + half_width)};
}

}  // namespace

double student_t(int degrees, int looks) {
  return boost::math::quantile(boost::math::students_t(degrees), 1.0 - 0.025 / looks);
}

Estimate estimate(std::span<const double> values, int looks) {
  const auto [mean, deviation] = of_logarithms(values);
  if (values.size() < 2) return {std::exp(mean)};
  const auto count = static_cast<double>(values.size());
  const double error = deviation / std::sqrt(count);
  const double half = student_t(static_cast<int>(values.size()) - 1, looks) * error;
  return {std::exp(mean), around(mean, half), around(mean, std::sqrt(2.0) * half), error};
}

std::map<int, double> least_by_block(const CellRecord& cell,
                                     const std::function<double(const Repetition&)>& figure) {
  return least(cell,
               [&](const Repetition& one) { return one.is_undisturbed() ? figure(one) : 0.0; });
}

std::map<int, double> trace_by_block(const CellRecord& cell, TraceClock clock) {
  return clock == TraceClock::kWall ? least_by_block(cell, &Repetition::trace_ms)
                                    : least(cell, &Repetition::trace_cpu_ms);
}

std::map<int, double> total_by_block(const CellRecord& cell, TraceClock clock) {
  if (clock == TraceClock::kWall) return least_by_block(cell, &Repetition::total_ms);
  return least(cell, [](const Repetition& one) { return one.ready_cpu_ms() + one.trace_cpu_ms; });
}

bool is_disturbed(const CellRecord& cell) {
  std::set<int> blocks;
  for (const Repetition& one : cell.repetitions) blocks.insert(one.block);
  return 2 * trace_by_block(cell, TraceClock::kWall).size() < blocks.size();
}

int blocks_for_precision(double spread, double precision, int maximum) {
  maximum = std::max(maximum, 2);
  const auto is_enough = [&](int blocks) {
    return std::sqrt(2.0) * student_t(blocks - 1) * spread / std::sqrt(blocks) <= precision;
  };
  if (!is_enough(maximum)) return maximum;  // the usual case of an unattainable precision
  int blocks = 2;
  while (!is_enough(blocks)) ++blocks;
  return blocks;
}

double spread_of(const CellRecord& cell) {
  std::vector<double> times;
  for (const Repetition& one : cell.repetitions) {
    if (one.is_undisturbed() && one.trace_ms > 0.0) times.push_back(one.trace_ms);
  }
  return times.size() < 2 ? 0.0 : of_logarithms(times).deviation;
}

}  // namespace beambench::measure

#include "harness/bench/stopping.hpp"

#include <algorithm>

#include "harness/bench/record/robust_statistics.hpp"

namespace beambench::bench {
namespace {

bool is_precise(std::span<const double> samples, double precision) {
  const std::optional<Interval> interval = repeat_interval(samples);
  return interval && 0.5 * (interval->high - interval->low) <= precision * median(samples);
}

}  // namespace

bool is_look(int repetitions, int minimum) {
  int look = minimum;
  while (look < repetitions) look += std::max(1, look / 4);
  return look == repetitions;
}

std::optional<StopReason> reason_to_stop(std::span<const double> cycles, double spent_ms,
                                         double allowance_ms, const StoppingRule& rule) {
  const auto repetitions = static_cast<int>(cycles.size());
  if (repetitions < rule.minimum) return std::nullopt;
  if (is_look(repetitions, rule.minimum) && is_precise(cycles, rule.precision)) {
    return StopReason::kPrecision;
  }
  if (repetitions >= rule.maximum) return StopReason::kRepetitions;
  if (spent_ms >= allowance_ms) return StopReason::kBudget;
  return std::nullopt;
}

}  // namespace beambench::bench

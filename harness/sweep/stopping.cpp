#include "harness/sweep/stopping.hpp"

#include <numeric>

#include "harness/record/robust_statistics.hpp"

namespace beambench {

bool is_precise(std::span<const double> totals_ms, double precision) {
  const std::optional<Interval> interval = median_interval(totals_ms);
  return interval && 0.5 * (interval->high - interval->low) <= precision * median(totals_ms);
}

std::optional<StopReason> reason_to_stop(std::span<const double> totals_ms, double allowance_ms,
                                         const StoppingRule& rule) {
  if (totals_ms.size() < static_cast<std::size_t>(rule.minimum)) return std::nullopt;
  if (is_precise(totals_ms, rule.precision)) return StopReason::kPrecision;
  if (totals_ms.size() >= static_cast<std::size_t>(rule.maximum)) return StopReason::kRepetitions;
  const double spent_ms = std::accumulate(totals_ms.begin(), totals_ms.end(), 0.0);
  if (spent_ms >= allowance_ms) return StopReason::kBudget;
  return std::nullopt;
}

}  // namespace beambench

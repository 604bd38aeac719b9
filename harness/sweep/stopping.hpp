#pragma once
// When a cell has been repeated often enough.

#include <optional>
#include <span>

#include "harness/record/cell_record.hpp"

namespace beambench {

struct StoppingRule {
  double precision;  ///< wanted half-width of the median's 95% interval, relative to the median
  int minimum;       ///< repetitions that are made in any case
  int maximum;
};

/// Is the median's interval known and narrow enough?
bool is_precise(std::span<const double> totals_ms, double precision);

/// Why to stop, or nothing while another repetition is due. `totals_ms` are the repetitions' times,
/// `allowance_ms` the cell's share of the budget, which the least repetitions may exceed.
std::optional<StopReason> reason_to_stop(std::span<const double> totals_ms, double allowance_ms,
                                         const StoppingRule& rule);

}  // namespace beambench

#pragma once
// When a cell has been repeated often enough.

#include <optional>
#include <span>

#include "harness/bench/record/cell_record.hpp"

namespace beambench::bench {

struct StoppingRule {
  double precision;  ///< wanted half-width of the interval of a repeat, relative to the median
  int minimum;       ///< repetitions that are made in any case
  int maximum;
};

/// Is the precision tested after so many repetitions? At the minimum, then each time a quarter more
/// have been made: a test after each one would stop at a lucky moment, when the interval happens to
/// be narrower than it should.
bool is_look(int repetitions, int minimum);

/// Why to stop, or nothing while another repetition is due. `cycles` are the repetitions' totals,
/// `spent_ms` what they took, `allowance_ms` the cell's share of the budget, which the minimum of
/// repetitions may exceed. The precision is reached when `repeat_interval` is known and narrow.
std::optional<StopReason> reason_to_stop(std::span<const double> cycles, double spent_ms,
                                         double allowance_ms, const StoppingRule& rule);

}  // namespace beambench::bench

#pragma once
// When a cell has been repeated often enough.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "harness/bench/contender.hpp"
#include "harness/bench/record/cell_record.hpp"

namespace beambench::bench {

struct StoppingRule {
  double precision;  ///< wanted half-width of the interval of a repeat, relative to the median
  int minimum;       ///< repetitions that are made in any case
  int maximum;
};

/// Is the interval of a repeat (`repeat_interval`) known and narrow enough?
bool is_precise(std::span<const double> samples, double precision);

/// Is the precision looked at after so many repetitions? At the minimum, then each time a quarter
/// more have been made: who looks after each one stops at a lucky moment, when the interval happens
/// to be narrower than it should.
bool is_look(int repetitions, int minimum);

/// Why to stop, or nothing while another repetition is due. `cycles` are the repetitions' totals,
/// `spent_ms` what they took, `allowance_ms` the cell's share of the budget, which the least
/// repetitions may exceed.
std::optional<StopReason> reason_to_stop(std::span<const double> cycles, double spent_ms,
                                         double allowance_ms, const StoppingRule& rule);

struct TurnRules {
  StoppingRule stopping;
  double allowance_ms;  ///< of timed work, for each contender
  std::uint64_t seed;   ///< of the order in each round
};

struct TurnEvents {
  std::function<void(const Contender&)> begins;     ///< it is about to be measured once more
  std::function<void(const CellRecord&)> finished;  ///< a contender is done
  std::function<void(double)> advanced;  ///< what the unfinished have done, in whole contenders
};

/// Runs rounds of one repetition for each contender still in the race, in an order shuffled anew
/// each round, until all are done: what slows the machine down for a while slows them all. Those
/// that have failed already finish at once.
void take_turns(std::vector<Contender> contenders, const Instruments& instruments,
                const TurnRules& rules, const TurnEvents& events);

}  // namespace beambench::bench

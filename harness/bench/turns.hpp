#pragma once
// The contenders of a group take turns.

#include <cstdint>
#include <functional>
#include <vector>

#include "harness/bench/contender.hpp"
#include "harness/bench/stopping.hpp"

namespace beambench::bench {

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

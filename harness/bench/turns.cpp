#include "harness/bench/turns.hpp"

#include <algorithm>
#include <utility>

#include "harness/bench/record/robust_statistics.hpp"
#include "scenes/core/random.hpp"

namespace beambench::bench {
namespace {

/// Fisher and Yates's shuffle, with random numbers that are the same on every machine.
void shuffle(std::vector<Contender>& contenders, Random& random) {
  for (std::size_t left = contenders.size(); left > 1; --left) {
    std::swap(contenders[left - 1], contenders[random.below(left)]);
  }
}

/// Takes those out of the race that are done.
void retire_done(std::vector<Contender>& racing, const TurnRules& rules, const TurnEvents& events) {
  std::vector<Contender> still;
  for (Contender& contender : racing) {
    std::optional<StopReason> reason;
    if (!contender.failed()) {
      reason = reason_to_stop(contender.cycles(), contender.spent_ms(), rules.allowance_ms,
                              rules.stopping);
    }
    if (reason || contender.failed()) {
      events.finished(std::move(contender).finish(reason));
    } else {
      still.push_back(std::move(contender));
    }
  }
  racing = std::move(still);
}

/// How far the unfinished are, in whole contenders: by the larger of the time and the repetitions
/// that they have used up.
double work_done(const std::vector<Contender>& racing, const TurnRules& rules) {
  double done = 0.0;
  for (const Contender& contender : racing) {
    const double time = contender.spent_ms() / std::max(rules.allowance_ms, 1.0);
    const double repetitions = static_cast<double>(contender.cycles().size());
    const double least = repetitions / rules.stopping.minimum;
    const double most = repetitions / rules.stopping.maximum;
    done += std::clamp(std::max(std::min(time, least), most), 0.0, 1.0);
  }
  return done;
}

}  // namespace

bool is_precise(std::span<const double> samples, double precision) {
  const std::optional<Interval> interval = repeat_interval(samples);
  return interval && 0.5 * (interval->high - interval->low) <= precision * median(samples);
}

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

void take_turns(std::vector<Contender> contenders, const Instruments& instruments,
                const TurnRules& rules, const TurnEvents& events) {
  Random random(rules.seed);
  retire_done(contenders, rules, events);
  for (int round = 0; !contenders.empty(); ++round) {
    shuffle(contenders, random);
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      events.begins(contenders[i]);
      contenders[i].repeat(instruments, round, static_cast<int>(i));
      events.advanced(work_done(contenders, rules));
    }
    retire_done(contenders, rules, events);
  }
}

}  // namespace beambench::bench

#include "harness/bench/harness_time.hpp"

#include <vector>

#include "harness/bench/conditions.hpp"
#include "harness/bench/phase_timer.hpp"
#include "harness/bench/record/robust_statistics.hpp"

namespace beambench::bench {

double harness_ms(int core, const std::function<void()>& trace) {
  constexpr int kTraces = 9;
  const PinnedThread pin(core);
  const MeasuringFloatMode mode;
  trace();
  std::vector<double> times;
  for (int i = 0; i < kTraces; ++i) times.push_back(time_phase(trace).wall_ms);
  return median(times);
}

}  // namespace beambench::bench

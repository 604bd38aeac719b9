#include "harness/sweep/harness_time.hpp"

#include <vector>

#include "harness/record/robust_statistics.hpp"
#include "harness/sweep/conditions.hpp"
#include "harness/sweep/phase_timer.hpp"

namespace beambench {

double harness_ms(int core, const std::function<void()>& trace) {
  constexpr int kTraces = 9;
  const PinnedThread pin(core);
  const MeasuringFloatMode mode;
  trace();
  std::vector<double> times;
  for (int i = 0; i < kTraces; ++i) times.push_back(time_phase(trace).wall_ms);
  return median(times);
}

}  // namespace beambench

#include "harness/sweep/harness_time.hpp"

#include <vector>

#include "accel/registry.hpp"
#include "harness/record/robust_statistics.hpp"
#include "harness/sweep/conditions.hpp"
#include "harness/sweep/phase_timer.hpp"

namespace beambench {

double harness_ms(const Scene& scene, const Question& question, Answers& answers, int core) {
  constexpr int kTraces = 5;
  const auto null = registry().choose({"null", {}}).build(scene);
  const PinnedThread pin(core);
  const MeasuringFloatMode mode;
  ask(*null, question, answers);
  std::vector<double> times;
  for (int i = 0; i < kTraces; ++i) {
    times.push_back(time_phase([&] { ask(*null, question, answers); }).wall_ms);
  }
  return median(times);
}

}  // namespace beambench

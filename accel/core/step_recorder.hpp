#pragma once
// Recording a ray's way: the third policy of a traversal, beside timing and counting.

#include <utility>
#include <vector>

#include "accel/core/trace_step.hpp"
#include "accel/core/work_counters.hpp"

namespace beambench::accel {

/// The policy of `Accelerator::explain`: keeps what timed code and counting let pass unmade.
class StepRecorder : public NoCounting {
 public:
  template <class Make>
  void enter(const Make& make) {
    steps_.push_back(make());
  }
  void tested(scenes::PrimitiveId primitive, float t) {
    if (steps_.empty()) steps_.emplace_back();  // of a structure that says nothing of its places
    steps_.back().tests.push_back({primitive, t});
  }

  std::vector<TraceStep> take_steps() && { return std::move(steps_); }

 private:
  std::vector<TraceStep> steps_;
};

}  // namespace beambench::accel

#pragma once
// The traversal path of one ray through a structure, recorded step by step.

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "accel/core/overlap.hpp"
#include "accel/core/ray.hpp"
#include "accel/core/work_counters.hpp"

namespace beambench::accel {

/// A ray-primitive test and its result. The test accepts only hits up to the best hit so far; a
/// primitive beyond that hit counts as missed.
struct TestedPrimitive {
  scenes::PrimitiveId primitive;
  float t;  ///< kMiss (canonical_ray.hpp) if the test found nothing
};

/// A cell, node or leaf that the ray entered.
struct TraceStep {
  std::string_view place = "scene";  ///< the family's word for it, such as "leaf"
  std::uint64_t index = 0;           ///< its number in the structure
  int level = 0;                     ///< the root has level 1; 0 if there are no levels
  std::optional<Box> box{};
  double t_enter = 0.0;  ///< the ray's interval in the cell, as computed by the traversal
  double t_exit = 0.0;
  std::vector<TestedPrimitive> tests{};  ///< in the order they were made
};

/// The policy of `Inspector::path`: records the places and tests that the other policies ignore.
class StepRecorder : public NoCounting {
 public:
  template <class Make>
  void enter(const Make& make) {
    steps_.push_back(make());
  }
  void tested(scenes::PrimitiveId primitive, float t) {
    if (steps_.empty()) steps_.emplace_back();  // for a structure that reports no places
    steps_.back().tests.push_back({primitive, t});
  }

  std::vector<TraceStep> take_steps() && { return std::move(steps_); }

 private:
  std::vector<TraceStep> steps_;
};

}  // namespace beambench::accel

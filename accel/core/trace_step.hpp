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

/// A ray-primitive test and its result. The test accepts hits up to the best one so far only:
/// beyond it a primitive is missed.
struct TestedPrimitive {
  scenes::PrimitiveId primitive;
  float t;  ///< kMiss (canonical_ray.hpp) where the test found nothing
};

/// A place that the ray entered: a cell, a node, a leaf.
struct TraceStep {
  std::string_view place = "scene";  ///< what it is, in the family's word: "leaf"
  std::uint64_t index = 0;           ///< its number in the structure
  int level = 0;                     ///< the root being level 1; 0 where there are no levels
  std::optional<Box> box{};
  double t_enter = 0.0;  ///< where the ray is in it, as the traversal computed it
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
    if (steps_.empty()) steps_.emplace_back();  // of a structure that reports no places
    steps_.back().tests.push_back({primitive, t});
  }

  std::vector<TraceStep> take_steps() && { return std::move(steps_); }

 private:
  std::vector<TraceStep> steps_;
};

}  // namespace beambench::accel

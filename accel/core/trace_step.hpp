#pragma once
// One step of a ray through a structure, for people to read.

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "accel/core/overlap.hpp"
#include "accel/core/ray.hpp"

namespace beambench::accel {

/// A ray-primitive test made on the way, and what came of it. The test asks for hits up to the best
/// one so far only: beyond it a primitive is missed.
struct TestedPrimitive {
  scenes::PrimitiveId primitive;
  float t;  ///< kMiss (canonical_ray.hpp) where the test found nothing
};

/// A place that the ray entered: a cell, a node, a leaf.
struct TraceStep {
  std::string_view place = "scene";  ///< what it is, a word of the family's: "leaf"
  std::uint64_t index = 0;           ///< its number in the structure
  int level = 0;                     ///< the root being level 1; 0 where there are no levels
  std::optional<Box> box{};
  double t_enter = 0.0;  ///< where the ray is in it, as the traversal computed it
  double t_exit = 0.0;
  std::vector<TestedPrimitive> tests{};  ///< in the order they were made
};

}  // namespace beambench::accel

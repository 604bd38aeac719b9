#pragma once
// Axis-aligned bounding boxes in single precision.

#include <limits>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace beambench::scenes {

/// An axis-aligned box, closed on all sides. A default-constructed box is empty (lower > upper).
struct Bounds {
  glm::vec3 lower{std::numeric_limits<float>::infinity()};
  glm::vec3 upper{-std::numeric_limits<float>::infinity()};

  bool empty() const { return lower.x > upper.x || lower.y > upper.y || lower.z > upper.z; }
  glm::vec3 extent() const { return empty() ? glm::vec3(0.0F) : upper - lower; }
  /// Returns the largest absolute coordinate of any point in the box, or 0 for an empty box.
  float largest_coordinate() const {
    const glm::vec3 largest = glm::max(glm::abs(lower), glm::abs(upper));
    return empty() ? 0.0F : glm::max(glm::max(largest.x, largest.y), largest.z);
  }

  void include(const glm::vec3& point) {
    lower = glm::min(lower, point);
    upper = glm::max(upper, point);
  }
  void include(const Bounds& other) {
    lower = glm::min(lower, other.lower);
    upper = glm::max(upper, other.upper);
  }
};

}  // namespace beambench::scenes

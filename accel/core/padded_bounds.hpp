#pragma once
// Boxes of primitives, widened so that no hit is lost.

#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "accel/core/tolerance.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel {

/// Returns the next float above a finite number; std::nextafter takes ten times as long.
inline float next_above(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  if (value == 0.0F) return std::numeric_limits<float>::denorm_min();
  return std::bit_cast<float>(value > 0.0F ? bits + 1 : bits - 1);
}

/// Returns the box widened by `tolerance` on every side, rounded outward to float.
inline scenes::Bounds padded(const scenes::Bounds& bounds, double tolerance) {
  scenes::Bounds wider;
  for (int axis = 0; axis < 3; ++axis) {
    // One float further outward covers the rounding of the difference and of its conversion.
    const auto lower = static_cast<float>(bounds.lower[axis] - tolerance);
    const auto upper = static_cast<float>(bounds.upper[axis] + tolerance);
    wider.lower[axis] = -next_above(-lower);
    wider.upper[axis] = next_above(upper);
  }
  return wider;
}

/// Returns a box for each primitive that contains every point at which a canonical test may hit it,
/// before t is rounded (tolerance.hpp).
inline std::vector<scenes::Bounds> padded_primitive_bounds(const scenes::Scene& scene) {
  const double tolerance = overlap_tolerance(scene);
  std::vector<scenes::Bounds> boxes;
  boxes.reserve(scene.primitives.size());
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    boxes.push_back(padded(scenes::primitive_bounds(scene, id), tolerance));
  }
  return boxes;
}

/// Returns half the surface area of a box, which is proportional to the probability that a ray that
/// meets an enclosing box also meets this one. Returns 0 for an empty box.
inline double half_area(const scenes::Bounds& bounds) {
  const glm::dvec3 size(bounds.extent());
  return size.x * (size.y + size.z) + size.y * size.z;
}

inline scenes::Bounds united(scenes::Bounds a, const scenes::Bounds& b) {
  a.include(b);
  return a;
}

}  // namespace beambench::accel

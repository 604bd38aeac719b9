#pragma once
// The straight line that a ray lies on.

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "accel/core/ray.hpp"

namespace beambench::verify {

/// The line of a ray, in double and with a direction of unit length.
struct RayLine {
  explicit RayLine(const accel::Ray& ray)
      : origin(ray.origin), direction(glm::normalize(glm::dvec3(ray.direction))) {}

  /// From the line to the point, perpendicular to the line.
  glm::dvec3 across(const glm::dvec3& point) const {
    const glm::dvec3 offset = point - origin;
    return offset - glm::dot(offset, direction) * direction;
  }
  double distance_to(const glm::dvec3& point) const { return glm::length(across(point)); }
  double distance_to_segment(const glm::dvec3& from, const glm::dvec3& to) const {
    const glm::dvec3 a = across(from);
    const glm::dvec3 edge = across(to) - a;
    const double length_2 = glm::dot(edge, edge);
    const double at = length_2 > 0.0 ? std::clamp(-glm::dot(a, edge) / length_2, 0.0, 1.0) : 0.0;
    return glm::length(a + at * edge);
  }

  glm::dvec3 origin;
  glm::dvec3 direction;
};

}  // namespace beambench::verify

#pragma once
// A ray as the canonical ray-primitive tests see it.

#include <optional>

#include <glm/vec3.hpp>

#include "accel/ray.hpp"

namespace beambench {

/// A ray widened to double. `t_max` shrinks while a traversal finds nearer hits.
struct CanonicalRay {
  explicit CanonicalRay(const Ray& ray)
      : origin(ray.origin), direction(ray.direction), t_min(ray.t_min), t_max(ray.t_max) {}

  glm::dvec3 at(double t) const { return origin + direction * t; }

  /// t rounded once to float, if it lies in the closed interval.
  std::optional<float> accept(double t) const {
    const auto rounded = static_cast<float>(t);
    if (rounded >= t_min && rounded <= t_max) return rounded;
    return std::nullopt;
  }

  glm::dvec3 origin;
  glm::dvec3 direction;
  float t_min;
  float t_max;
};

}  // namespace beambench

#pragma once
// Rays and hits: the input and the result of a query.

#include <cstdint>
#include <limits>

#include <glm/vec3.hpp>

#include "scenes/primitive.hpp"

namespace beambench::accel {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The minimum length of the longest component of a direction. In shorter directions, the other
/// components soon become subnormal and lose digits, or count as 0 where subnormals are flushed.
inline constexpr float kShortestDirection = 1e-30F;

/// The points origin + t * direction with t in the ray's interval (`in_interval`). The direction
/// need not have unit length; t is in units of its length (view depth for primary rays).
struct Ray {
  glm::vec3 origin{0.0F};
  float t_min = 0.0F;
  glm::vec3 direction{0.0F, 0.0F, -1.0F};
  float t_max = kInfinity;
};

/// Returns whether t is in the ray's interval; the rule is the same for structures, the oracle,
/// exact search and hit files. A hit counts if its t, rounded once to float, is finite and lies in
/// the closed interval [t_min, t_max]. So a ray whose t_max is the t of its own hit still has that
/// hit; a t beyond the largest float is never a hit.
inline bool in_interval(const Ray& ray, float t) {
  return t >= ray.t_min && t <= ray.t_max && t <= std::numeric_limits<float>::max();
}
inline bool in_interval(const Ray& ray, double t) {
  return in_interval(ray, static_cast<float>(t));
}

/// The first point at which a ray meets a primitive. `t` was computed in double and rounded once;
/// it is finite, and a zero is +0.
struct Hit {
  float t;
  scenes::PrimitiveId primitive;

  friend bool operator==(const Hit&, const Hit&) = default;
};

/// Orders hits: the nearer first; at equal t, the lower primitive id. This makes "the closest hit"
/// unique, whatever the order in which primitives are tested.
constexpr bool precedes(const Hit& a, const Hit& b) {
  return a.t < b.t || (a.t == b.t && a.primitive < b.primitive);
}

/// Throws InputError if a number is NaN, an origin or direction is not finite, a coordinate is
/// beyond 1e9, all components of the direction are smaller than kShortestDirection, or t_min < 0.
/// Called wherever rays come from outside; kernels rely on it.
void require_valid(const Ray& ray);

}  // namespace beambench::accel

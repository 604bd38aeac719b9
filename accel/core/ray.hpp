#pragma once
// Rays and hits: the input and the result of a query.

#include <cstdint>
#include <limits>

#include <glm/vec3.hpp>

#include "scenes/primitive.hpp"

namespace beambench::accel {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The minimum length of the longest component of a direction. With smaller ones, the other
/// components soon become too small for a normal float and lose digits, or count as 0 where
/// denormals do.
inline constexpr float kShortestDirection = 1e-30F;

/// The points origin + t * direction with t in the interval of `in_interval`. The direction need
/// not have unit length; t counts in its units (for primary rays: view depth).
struct Ray {
  glm::vec3 origin{0.0F};
  float t_min = 0.0F;
  glm::vec3 direction{0.0F, 0.0F, -1.0F};
  float t_max = kInfinity;
};

/// The rule for the ends of a ray, the same for structures, oracle, exact search and hits files: a
/// hit counts if its t, rounded once to float, is finite and lies in the closed interval
/// [t_min, t_max]. So a ray whose t_max is the t of its own hit has that hit; a t beyond the
/// largest float is not a hit, whatever t_max is.
inline bool in_interval(const Ray& ray, float t) {
  return t >= ray.t_min && t <= ray.t_max && t <= std::numeric_limits<float>::max();
}
inline bool in_interval(const Ray& ray, double t) {
  return in_interval(ray, static_cast<float>(t));
}

/// Where a ray meets a primitive first. `t` was computed in double and rounded once; it is finite,
/// and a zero is +0.
struct Hit {
  float t;
  scenes::PrimitiveId primitive;

  friend bool operator==(const Hit&, const Hit&) = default;
};

/// The order of hits: the nearer first, at equal t the lower primitive id. This makes "the closest
/// hit" one hit, whatever the order in which primitives are tested.
constexpr bool precedes(const Hit& a, const Hit& b) {
  return a.t < b.t || (a.t == b.t && a.primitive < b.primitive);
}

/// Throws InputError when a number is NaN, an origin or direction is not finite, a coordinate is
/// beyond 1e9, all components of the direction are smaller than kShortestDirection, or t_min < 0.
/// Called wherever rays come from outside; kernels rely on it.
void require_valid(const Ray& ray);

}  // namespace beambench::accel

#pragma once
// A ray in the form that the canonical ray-primitive tests use.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include <glm/common.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "accel/core/ray.hpp"

namespace beambench::accel {

/// The result of a ray-primitive test that misses: a NaN, which neither precedes nor equals any t.
/// (An optional<float> would be passed through memory in two halves, which took longer than the
/// test itself.)
inline constexpr float kMiss = std::numeric_limits<float>::quiet_NaN();
inline bool is_hit(float t) { return t == t; }

/// Returns the axis along which a direction is longest; of equally long ones, the last.
inline std::size_t longest_axis(const glm::vec3& direction) {
  // A table, because the directions of secondary rays defeat branch prediction.
  static constexpr std::array<std::uint8_t, 8> kAxes{2, 2, 2, 0, 1, 2, 1, 0};
  const glm::vec3 size = glm::abs(direction);
  return kAxes[std::size_t{size.x > size.y} + 2 * std::size_t{size.x > size.z} +
               4 * std::size_t{size.y > size.z}];
}

/// Sets `main_axis`, `side_axis` and `shear` of a ray in any precision.
template <class ShearedRay>
void set_shear(ShearedRay& ray, const glm::vec3& direction) {
  static constexpr std::array<std::uint8_t, 5> kCycle{0, 1, 2, 0, 1};
  const std::size_t main = longest_axis(direction);
  using Number = std::remove_reference_t<decltype(ray.shear[0])>;
  const float* components = glm::value_ptr(direction);
  const Number along = components[main];
  ray.main_axis = static_cast<decltype(ray.main_axis)>(main);
  ray.side_axis = {kCycle[main + 1], kCycle[main + 2]};
  ray.shear = {components[kCycle[main + 1]] / along, components[kCycle[main + 2]] / along};
}

/// Returns t rounded once to float if it lies in the closed interval [t_min, t_max], otherwise
/// kMiss. A zero is +0, so that equal hits have equal bits, whichever primitive or triangle is
/// tested first.
inline float accept(double t, float t_min, float t_max) {
  const float rounded = static_cast<float>(t) + 0.0F;
  return rounded >= t_min && rounded <= t_max ? rounded : kMiss;
}

/// Returns the end of an interval for `accept`: a t that rounds to infinity is not a hit.
inline float finite(float t_max) { return std::min(t_max, std::numeric_limits<float>::max()); }

/// A ray widened to double. `t_max` is finite and shrinks while a traversal finds nearer hits.
struct CanonicalRay {
  explicit CanonicalRay(const Ray& ray)
      : origin(ray.origin), direction(ray.direction), t_min(ray.t_min), t_max(finite(ray.t_max)) {
    set_shear(*this, ray.direction);
  }

  glm::dvec3 at(double t) const { return origin + direction * t; }

  float accept(double t) const { return accel::accept(t, t_min, t_max); }

  /// Returns a point's position in the ray's frame: relative to the origin and sheared along the
  /// main axis so that the ray becomes that axis (Woop, Benthin and Wald, "Watertight Ray/Triangle
  /// Intersection", 2013).
  glm::dvec2 beside(const glm::vec3& point) const {
    // Use a pointer: glm's operator[] is a chain of branches, which took 5% of a trace of
    // triangles.
    const float* place = glm::value_ptr(point);
    const double* from = glm::value_ptr(origin);
    const double along = place[main_axis] - from[main_axis];
    return {place[side_axis[0]] - from[side_axis[0]] - shear[0] * along,
            place[side_axis[1]] - from[side_axis[1]] - shear[1] * along};
  }

  glm::dvec3 origin;
  glm::dvec3 direction;
  float t_min;
  float t_max;
  int main_axis;                 ///< the axis along which the direction is longest
  std::array<int, 2> side_axis;  ///< the other two axes
  std::array<double, 2> shear;   ///< direction on the side axes over that on the main axis
};

/// Returns a root t of a surface's equation f(t) = 0 on a ray. If t is close to 0, relative to
/// `scale`, it has lost its digits to cancellation. Because a ray that begins on the surface must
/// find t = 0, -f(0) / f'(0) is returned instead. `at_origin` returns f(0) and f'(0) / 2.
template <class AtOrigin>
double root_near_origin(double t, double scale, AtOrigin at_origin) {
  if (std::abs(t) > 0x1p-40 * scale) return t;
  const glm::dvec2 value_and_half_slope = at_origin();
  return value_and_half_slope.y != 0.0 ? -0.5 * value_and_half_slope.x / value_and_half_slope.y : t;
}

}  // namespace beambench::accel

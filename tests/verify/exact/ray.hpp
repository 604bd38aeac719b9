#pragma once
// A ray in exact arithmetic.

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "accel/core/ray.hpp"
#include "tests/verify/exact/vector.hpp"

namespace beambench::exact {

/// A bound of an interval of numbers, open or closed.
struct Bound {
  Number at;
  bool closed;
};

/// Returns the numbers whose nearest float is at least `limit`: ties go to the float with the even
/// mantissa.
inline Bound rounding_to_at_least(float limit) {
  const double below = std::nextafter(limit, -std::numeric_limits<float>::infinity());
  return {Number(limit) + (Number(below) - Number(limit)).times_two_to(-1),
          std::bit_cast<std::uint32_t>(limit) % 2 == 0};
}

/// Returns the numbers whose nearest float is at most `limit`; infinity is beyond the largest
/// float.
inline Bound rounding_to_at_most(float limit) {
  limit = std::min(limit, std::numeric_limits<float>::max());
  const float above = std::nextafter(limit, std::numeric_limits<float>::infinity());
  const double next = std::isinf(above) ? 0x1p128 : double{above};
  return {Number(limit) + (Number(next) - Number(limit)).times_two_to(-1),
          std::bit_cast<std::uint32_t>(limit) % 2 == 0};
}

/// A ray whose direction is scaled by the power of two that brings its longest component into
/// [0.5, 1). Its points are origin + s direction with the parameter s.
class ExactRay {
 public:
  explicit ExactRay(const accel::Ray& ray)
      : given(ray),
        origin(glm::dvec3(ray.origin)),
        from(rounding_to_at_least(ray.t_min)),
        to(rounding_to_at_most(ray.t_max)) {
    const glm::dvec3 size = glm::abs(glm::dvec3(ray.direction));
    std::frexp(std::max({size.x, size.y, size.z}), &scale_);
    const glm::dvec3 scaled(std::ldexp(double{ray.direction.x}, -scale_),
                            std::ldexp(double{ray.direction.y}, -scale_),
                            std::ldexp(double{ray.direction.z}, -scale_));
    direction = Vector(scaled);
    speed = length(direction);
    from.at = from.at.times_two_to(scale_);
    to.at = to.at.times_two_to(scale_);
  }

  /// Returns the parameter of a t of the given ray. `t` must be finite.
  Number parameter(float t) const { return Number(t).times_two_to(scale_); }
  /// Returns the t, not rounded to float.
  double t_of(double parameter) const { return std::ldexp(parameter, -scale_); }

  /// Returns whether the float nearest to the exact t lies in the interval of the given ray.
  bool contains(const Root& s) const {
    const int above = compare(s, from.at);
    const int below = compare(s, to.at);
    return (above > 0 || (above == 0 && from.closed)) && (below < 0 || (below == 0 && to.closed));
  }

  glm::dvec3 at(double parameter) const {
    return glm::dvec3(given.origin) + parameter * direction.rounded();
  }
  Vector at(const Number& parameter) const { return origin + parameter * direction; }

  accel::Ray given;
  Vector origin;
  Vector direction;
  double speed;  ///< the length of `direction`
  Bound from;    ///< of the parameters in the interval
  Bound to;

 private:
  int scale_ = 0;
};

}  // namespace beambench::exact

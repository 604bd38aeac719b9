#pragma once
// The tolerances within which the judge does not distinguish points.

#include <algorithm>
#include <limits>

#include <glm/vec3.hpp>

#include "accel/core/ray.hpp"
#include "accel/core/tolerance.hpp"

namespace beambench::verify {

/// Returns K u for a point on the ray (`accel::float_unit`): the distance within which points near
/// it cannot be distinguished in float. At least the smallest normal float, because smaller numbers
/// are flushed to 0.
inline double tolerance(const accel::Ray& ray, const glm::dvec3& point) {
  return std::max<double>(accel::kUnits * accel::float_unit(glm::dvec3(ray.origin), point),
                          std::numeric_limits<float>::min());
}
inline double tolerance(const accel::Ray& ray, double t) {
  return tolerance(ray, glm::dvec3(ray.origin) + t * glm::dvec3(ray.direction));
}

/// The number of tolerances that two equal places may be apart along the ray. At grazing incidence,
/// places that are close across a surface are far apart along it; beyond this limit, the sine of
/// the incidence is below 1/1024, and they count as two places.
inline constexpr double kAlong = 1024.0;

}  // namespace beambench::verify

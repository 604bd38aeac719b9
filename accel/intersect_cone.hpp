#pragma once
// The canonical ray-cone test.

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "accel/canonical_ray.hpp"
#include "accel/tolerance.hpp"
#include "scenes/primitive.hpp"

namespace beambench {

/// The smallest t in the ray's interval at which it meets the lateral surface of the cone frustum
/// or cylinder (no caps); of a cone seen from the inside only, the smallest at which it leaves.
/// With m = o + t d - base and the axis parameter s(t) = m . axis / |axis|^2, the surface is
/// |m - s axis|^2 = (r_base + s (r_apex - r_base))^2 for s in [0, 1], a quadratic in t. The origin
/// is first moved to the point of the ray closest to the axis' middle, so that distant cones do not
/// cancel. Near the tip, where the quadratic is ill-conditioned, a root whose point is farther than
/// kHitSlack from the surface's solid is not a hit.
inline std::optional<float> intersect_cone(const CanonicalRay& ray, const Cone& cone) {
  const glm::dvec3 base(cone.base);
  const glm::dvec3 axis = glm::dvec3(cone.apex) - base;
  const double axis_squared = glm::dot(axis, axis);
  const glm::dvec3 middle = base + axis * 0.5;
  const double t_near =
      glm::dot(middle - ray.origin, ray.direction) / glm::dot(ray.direction, ray.direction);
  const glm::dvec3 start = ray.at(t_near) - base;

  // Axis parameter, radial vector and radius, each as value + slope * (t - t_near).
  const double s_value = glm::dot(start, axis) / axis_squared;
  const double s_slope = glm::dot(ray.direction, axis) / axis_squared;
  const glm::dvec3 radial_value = start - axis * s_value;
  const glm::dvec3 radial_slope = ray.direction - axis * s_slope;
  const double taper = static_cast<double>(cone.apex_radius) - cone.base_radius;
  const double radius_value = cone.base_radius + s_value * taper;
  const double radius_slope = s_slope * taper;

  const double a = glm::dot(radial_slope, radial_slope) - radius_slope * radius_slope;
  const double b = glm::dot(radial_value, radial_slope) - radius_value * radius_slope;
  const double c = glm::dot(radial_value, radial_value) - radius_value * radius_value;
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0) return std::nullopt;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  double roots[2] = {q / a, c / q};  // a or q may be 0: that root is infinite or NaN, and not taken
  if (roots[1] < roots[0]) std::swap(roots[0], roots[1]);

  const double reach = glm::length(middle - ray.origin) + std::sqrt(axis_squared) +
                       std::max(cone.base_radius, cone.apex_radius);
  for (const double root : roots) {
    const double s = s_value + root * s_slope;
    if (!(s >= 0.0 && s <= 1.0)) continue;
    if (cone.inside_only && a * root + b <= 0.0) continue;
    const glm::dvec3 radial = radial_value + radial_slope * root;
    const double allowed = radius_value + radius_slope * root + kHitSlack * reach;
    if (!(glm::dot(radial, radial) <= allowed * allowed)) continue;
    if (const auto t = ray.accept(t_near + root)) return t;
  }
  return std::nullopt;
}

}  // namespace beambench

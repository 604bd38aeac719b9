#pragma once
// The canonical ray-cone test.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "accel/canonical_ray.hpp"
#include "accel/tolerance.hpp"
#include "scenes/primitive.hpp"

namespace beambench {

/// A quantity that changes linearly along a ray: value + slope * t.
template <class T>
struct Linear {
  T value;
  T slope;

  T at(double t) const { return value + slope * t; }
};

/// The smallest t in the ray's interval at which it meets the lateral surface of the cone frustum
/// or cylinder (no caps); of a cone seen from the inside only, the smallest at which it leaves.
/// With m = o + t d - base and the axis parameter s(t) = m . axis / |axis|^2, the surface is
/// |m - s axis| = r_base + s (r_apex - r_base) for s in [0, 1]: squared, a quadratic in t. The
/// origin is first moved to the point of the ray closest to the axis' middle, so that distant cones
/// do not cancel. Near the tip the quadratic is ill-conditioned: its roots are improved by a step
/// of Newton's method on the equation before squaring, and one whose point is still farther than
/// kHitSlack from the surface is not a hit.
inline float intersect_cone(const CanonicalRay& ray, const Cone& cone) {
  const glm::dvec3 base(cone.base);
  const glm::dvec3 axis = glm::dvec3(cone.apex) - base;
  const double axis_squared = glm::dot(axis, axis);
  const glm::dvec3 middle = base + axis * 0.5;
  const double t_near =
      glm::dot(middle - ray.origin, ray.direction) / glm::dot(ray.direction, ray.direction);
  const glm::dvec3 start = ray.at(t_near) - base;

  const Linear<double> s{glm::dot(start, axis) / axis_squared,
                         glm::dot(ray.direction, axis) / axis_squared};
  const Linear<glm::dvec3> radial{start - axis * s.value, ray.direction - axis * s.slope};
  const double taper = static_cast<double>(cone.apex_radius) - cone.base_radius;
  const Linear<double> radius{cone.base_radius + s.value * taper, s.slope * taper};

  const double a = glm::dot(radial.slope, radial.slope) - radius.slope * radius.slope;
  const double b = glm::dot(radial.value, radial.slope) - radius.value * radius.slope;
  const double c = glm::dot(radial.value, radial.value) - radius.value * radius.value;
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0) return kMiss;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  std::array<double, 2> roots{
      q / a, c / q};  // a or q may be 0: that root is infinite or NaN, and not taken

  const auto off_surface = [&](double t) { return glm::length(radial.at(t)) - radius.at(t); };
  for (double& root : roots) {
    const double distance = glm::length(radial.at(root));
    const double slope = glm::dot(radial.at(root), radial.slope) / distance - radius.slope;
    const double improved = root - (distance - radius.at(root)) / slope;
    if (std::abs(off_surface(improved)) < std::abs(off_surface(root))) root = improved;
  }
  if (roots[1] < roots[0]) std::swap(roots[0], roots[1]);

  const double reach = glm::length(middle - ray.origin) + std::sqrt(axis_squared) +
                       std::max(cone.base_radius, cone.apex_radius);
  const double slack = kHitSlack * reach * std::sqrt(1.0 + taper * taper / axis_squared);
  for (const double root : roots) {
    if (!(std::abs(off_surface(root)) <= slack)) continue;
    if (!(s.at(root) >= 0.0 && s.at(root) <= 1.0)) continue;
    if (cone.inside_only && a * root + b <= 0.0) continue;
    const float t = ray.accept(t_near + root);
    if (is_hit(t)) return t;
  }
  return kMiss;
}

}  // namespace beambench

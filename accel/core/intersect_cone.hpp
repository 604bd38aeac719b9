#pragma once
// The canonical ray-cone test.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "accel/core/canonical_ray.hpp"
#include "accel/core/tolerance.hpp"
#include "scenes/primitive.hpp"

namespace beambench::accel {

/// A quantity that changes linearly along a ray: value + slope * t.
template <class T>
struct Linear {
  T value;
  T slope;

  T at(double t) const { return value + slope * t; }
};

/// Returns the smallest t in the ray's interval at which it meets the lateral surface of the cone
/// frustum or cylinder (no caps); for a cone seen only from the inside, the smallest t at which the
/// ray leaves it. With m = o + t d - middle and the axis parameter s(t) = m . axis / |axis|^2, the
/// surface is |m - s axis| = r_middle + s (r_apex - r_base) for s in [-1/2, 1/2]: squared, a
/// quadratic in t. The origin is first moved to the point of the ray closest to the middle of the
/// axis, which avoids cancellation for distant cones. So that this also holds for flat cones,
/// "closest" is measured with heights stretched until the surface is nowhere flatter than 45
/// degrees. Near the tip the quadratic is ill-conditioned: a step of Newton's method on the
/// unsquared equation improves its roots, and a root whose point is still farther than kHitSlack
/// from the surface is not a hit.
inline float intersect_cone(const CanonicalRay& ray, const scenes::Cone& cone) {
  const glm::dvec3 base(cone.base);
  const glm::dvec3 axis = glm::dvec3(cone.apex) - base;
  const double axis_squared = glm::dot(axis, axis);
  const glm::dvec3 middle = base + axis * 0.5;
  const double taper = static_cast<double>(cone.apex_radius) - cone.base_radius;

  const glm::dvec3 from_middle = ray.origin - middle;
  const Linear<double> height{glm::dot(from_middle, axis) / axis_squared,
                              glm::dot(ray.direction, axis) / axis_squared};
  const Linear<glm::dvec3> across{from_middle - axis * height.value,
                                  ray.direction - axis * height.slope};
  // The point closest to the middle; its height is written to avoid cancellation.
  const double stretched = std::max(axis_squared, taper * taper);
  const double spread = glm::dot(across.slope, across.slope);
  const double drift = glm::dot(across.value, across.slope);
  const double norm = spread + stretched * height.slope * height.slope;
  const double t_near = -(drift + stretched * height.value * height.slope) / norm;
  const Linear<double> s{(height.value * spread - height.slope * drift) / norm, height.slope};
  const Linear<glm::dvec3> radial{across.at(t_near), across.slope};
  const Linear<double> radius{
      0.5 * (static_cast<double>(cone.base_radius) + cone.apex_radius) + s.value * taper,
      s.slope * taper};

  const double a = glm::dot(radial.slope, radial.slope) - radius.slope * radius.slope;
  const double b = glm::dot(radial.value, radial.slope) - radius.value * radius.slope;
  const double c = glm::dot(radial.value, radial.value) - radius.value * radius.value;
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0) return kMiss;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  std::array<double, 2> roots{
      q / a, c / q};  // a or q may be 0: that root is infinite or NaN and is rejected

  const auto off_surface = [&](double t) { return glm::length(radial.at(t)) - radius.at(t); };
  for (double& root : roots) {
    const double distance = glm::length(radial.at(root));
    const double slope = glm::dot(radial.at(root), radial.slope) / distance - radius.slope;
    const double improved = root - (distance - radius.at(root)) / slope;
    if (std::abs(off_surface(improved)) < std::abs(off_surface(root))) root = improved;
  }
  if (roots[1] < roots[0]) std::swap(roots[0], roots[1]);

  const double reach = glm::length(from_middle) + std::sqrt(axis_squared) +
                       std::max(cone.base_radius, cone.apex_radius);
  const double slack = kHitSlack * reach * std::sqrt(1.0 + taper * taper / axis_squared);
  for (const double root : roots) {
    if (!(std::abs(off_surface(root)) <= slack)) continue;
    if (!(s.at(root) >= -0.5 && s.at(root) <= 0.5)) continue;
    if (cone.inside_only && a * root + b <= 0.0) continue;
    const float t = ray.accept(root_near_origin(t_near + root, std::abs(t_near), [&] {
      const double radius_0 =
          0.5 * (static_cast<double>(cone.base_radius) + cone.apex_radius) + height.value * taper;
      return glm::dvec2(glm::dot(across.value, across.value) - radius_0 * radius_0,
                        drift - radius_0 * taper * height.slope);
    }));
    if (is_hit(t)) return t;
  }
  return kMiss;
}

}  // namespace beambench::accel

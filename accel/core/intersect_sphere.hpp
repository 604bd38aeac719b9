#pragma once
// The canonical ray-sphere test.

#include <cmath>

#include <glm/geometric.hpp>

#include "accel/core/canonical_ray.hpp"
#include "scenes/primitive.hpp"

namespace beambench::accel {

/// Returns the smallest t in the ray's interval at which it meets the (hollow) sphere; for a sphere
/// seen only from the inside, the t at which the ray leaves it. The discriminant is taken from the
/// vector between the center and the ray's closest point, which avoids cancellation for small or
/// distant spheres (Haines et al., "Precision Improvements for Ray/Sphere Intersection", Ray
/// Tracing Gems, 2019); the point at t is then off the surface by at most a few ulps of its
/// distance.
inline float intersect_sphere(const CanonicalRay& ray, const scenes::Sphere& sphere) {
  const glm::dvec3 from_center = ray.origin - glm::dvec3(sphere.center);
  const double inverse = 1.0 / glm::dot(ray.direction, ray.direction);
  const double t_closest = -glm::dot(from_center, ray.direction) * inverse;
  const glm::dvec3 closest = from_center + ray.direction * t_closest;
  const double radius = sphere.radius;
  const double discriminant = radius * radius - glm::dot(closest, closest);
  if (discriminant < 0.0) return kMiss;
  const double half_chord = std::sqrt(discriminant * inverse);
  const auto accepted = [&](double t) {
    return ray.accept(root_near_origin(t, half_chord, [&] {
      return glm::dvec2(glm::dot(from_center, from_center) - radius * radius,
                        glm::dot(from_center, ray.direction));
    }));
  };
  if (!sphere.inside_only) {
    const float t = accepted(t_closest - half_chord);
    if (is_hit(t)) return t;
  }
  return accepted(t_closest + half_chord);
}

}  // namespace beambench::accel

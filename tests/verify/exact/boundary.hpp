#pragma once
// Decides whether the line of a ray passes close to a primitive's boundary as seen along the ray:
// the edges of a polygon's triangles, the silhouette of a sphere, the silhouette or rims of a cone.
// Distances are between the line and the boundary in space.

#include <array>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/verify/exact/crossing.hpp"

namespace beambench::exact {

/// The outcome of decisions that exact arithmetic cannot afford: for or against the claim.
enum class Doubt { kFavors, kOpposes };

inline bool is_near_point(const ExactRay& ray, const Vector& point, const Number& within_2) {
  return square(cross(point - ray.origin, ray.direction)) <= within_2 * square(ray.direction);
}

inline bool is_near_segment(const ExactRay& ray, const Vector& a, const Vector& b,
                            const Number& within_2) {
  const Vector edge = b - a;
  const Vector across = cross(ray.direction, edge);
  const Number across_2 = square(across);
  if (across_2.sign() > 0) {
    // The edge's line is nearest at a + (along / across_2) edge.
    const Vector offset = ray.origin - a;
    const Number along = dot(cross(ray.direction, offset), across);
    if (along.sign() >= 0 && along <= across_2) {
      return dot(offset, across).squared() <= within_2 * across_2;
    }
  }
  return is_near_point(ray, a, within_2) || is_near_point(ray, b, within_2);
}

inline bool is_near_edge(const ExactRay& ray, const Triangle& triangle, const Number& within_2) {
  return is_near_segment(ray, triangle.a, triangle.b, within_2) ||
         is_near_segment(ray, triangle.b, triangle.c, within_2) ||
         is_near_segment(ray, triangle.c, triangle.a, within_2);
}

inline bool is_near_boundary(const Polygon& polygon, const ExactRay& ray, double within, Doubt) {
  const Number within_2 = Number(within).squared();
  return std::ranges::any_of(polygon.triangles, [&](const Triangle& triangle) {
    return is_near_edge(ray, triangle, within_2);
  });
}

inline bool is_near_boundary(const Sphere& sphere, const ExactRay& ray, double within, Doubt) {
  const Number distance_2 = square(cross(sphere.center - ray.origin, ray.direction));
  const Number speed_2 = square(ray.direction);
  const Number outer = sphere.radius + Number(within);
  const Number inner = sphere.radius - Number(within);
  return distance_2 <= outer.squared() * speed_2 &&
         (inner.sign() <= 0 || distance_2 >= inner.squared() * speed_2);
}

/// Returns whether |value| > |gradient| within + bend within^2: a function that changes by no more
/// has no zero within that distance.
inline bool has_no_zero(const Number& value, const Vector& gradient, const Number& bend,
                        double within) {
  const double change = length(gradient) * within + bend.rounded() * within * within;
  return value.abs() > Number(change);
}

/// Returns whether the line is certainly away from a rim. The line crosses the plane of the rim at
/// distance |w| / |climb| from the rim's center, where w is linear in the origin of the ray.
inline bool is_far_from_rim(const ExactRay& ray, const Cone& cone, const Vector& center,
                            const Number& radius, double within) {
  const Vector offset = ray.origin - center;
  const Number climb = dot(ray.direction, cone.axis);
  const Vector w = climb * offset - dot(offset, cone.axis) * ray.direction;
  const Number value = square(w) - (radius * climb).squared();
  const Vector gradient = Number(2.0) * (climb * w - dot(w, ray.direction) * cone.axis);
  const double turn = std::abs(climb.rounded()) + length(cone.axis) * ray.speed;
  return has_no_zero(value, gradient, Number(turn).squared(), within);
}

/// Returns whether the line is certainly away from sign changes of the discriminant of the cone's
/// equation, which is a quadratic form of the ray's origin.
inline bool is_far_from_silhouette(const ExactRay& ray, const Cone& cone, double within) {
  const ConeEquation e(cone, ray.origin, ray.direction);
  const Number length_4 = cone.length_2.squared();
  const Number taper_2 = cone.taper.squared();
  const Vector gradient_b =
      length_4 * ray.direction - (e.climb * (cone.length_2 + taper_2)) * cone.axis;
  const Vector gradient_c =
      Number(2.0) *
      (length_4 * e.offset - (e.height * cone.length_2 + e.radius * cone.taper) * cone.axis);
  const Vector gradient = (Number(2.0) * e.b) * gradient_b - e.a * gradient_c;
  const Number bend = square(gradient_b) + e.a.abs() * (length_4 + taper_2 * cone.length_2);
  return has_no_zero(e.b.squared() - e.a * e.c, gradient, bend, within);
}

/// Returns points at steps of a sixteenth of a circle, of radius below 1.
inline const std::array<std::array<double, 2>, 16>& around() {
  static const auto kAround = [] {
    constexpr double kA = 0.9238795325112867;
    constexpr double kB = 0.7071067811865475;
    constexpr double kC = 0.3826834323650897;
    const std::array<double, 16> cosines{1,  kA,  kB,  kC,  0, -kC, -kB, -kA,
                                         -1, -kA, -kB, -kC, 0, kC,  kB,  kA};
    std::array<std::array<double, 2>, 16> made{};
    for (std::size_t i = 0; i < 16; ++i) made[i] = {cosines[i], cosines[(i + 12) % 16]};
    return made;
  }();
  return kAround;
}

/// Returns how a line crosses a cone, as counts, which change only at a boundary.
inline std::array<int, 2> crossing_counts(const Cone& cone, const ExactRay& ray) {
  std::vector<Crossing> found;
  Cone both_sides = cone;
  both_sides.inside_only = false;
  add_crossings(both_sides, ray, found);
  std::array<int, 2> counts{};
  for (const Crossing& crossing : found) ++counts[crossing.leaves ? 1 : 0];
  return counts;
}

/// Returns whether the line is near the boundary. With Doubt::kOpposes, it is near only if a ray
/// shifted by `within` crosses the cone differently. With Doubt::kFavors, it is far only if no
/// function that vanishes on the boundary can vanish within this distance.
inline bool is_near_boundary(const Cone& cone, const ExactRay& ray, double within, Doubt doubt) {
  if (doubt == Doubt::kFavors) {
    return !(is_far_from_silhouette(ray, cone, within) &&
             is_far_from_rim(ray, cone, cone.base, cone.base_radius, within) &&
             is_far_from_rim(ray, cone, cone.apex, cone.apex_radius, within));
  }
  const glm::dvec3 along = glm::normalize(ray.direction.rounded());
  const glm::dvec3 aside = glm::normalize(glm::cross(
      along, std::abs(along.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0)));
  const glm::dvec3 upward = glm::cross(along, aside);
  const std::array<int, 2> here = crossing_counts(cone, ray);
  return std::ranges::any_of(around(), [&](const std::array<double, 2>& step) {
    ExactRay shifted = ray;
    shifted.origin =
        ray.origin + Vector(within * (1.0 - 0x1p-30) * (step[0] * aside + step[1] * upward));
    return crossing_counts(cone, shifted) != here;
  });
}

inline bool is_near_boundary(const Solid& solid, const ExactRay& ray, double within, Doubt doubt) {
  return std::visit([&](const auto& shape) { return is_near_boundary(shape, ray, within, doubt); },
                    solid.shape);
}

}  // namespace beambench::exact

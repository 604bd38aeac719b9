#pragma once
// Rays for which hits are hard to judge.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "accel/core/ray.hpp"
#include "scenes/scene.hpp"
#include "tests/verify/exact/acceptance.hpp"
#include "tests/verify/exact/claim_scenes.hpp"

namespace beambench::exact {

/// How the rays of a family are drawn: origins, ends and lengths of directions.
struct RayStyle {
  enum class Start { kAround, kOnSurface, kInPlane, kAny };
  enum class Limits { kNone, kSegment, kOwnT, kAny };
  Start start = Start::kAny;
  Limits limits = Limits::kAny;
  bool all_exponents = false;  ///< of directions
  bool all_sizes = false;      ///< scene and ray are multiplied by a power of two
};

/// The part of the scene that rays are aimed at; large primitives extend beyond it.
constexpr double kReach = 3.0;

inline glm::dvec3 point_on_triangle(const std::array<glm::dvec3, 3>& corner, Random& random) {
  const std::uint64_t mode = random.below(5);
  if (mode == 0) return corner[random.below(3)];
  const glm::dvec3 u = corner[1] - corner[0];
  const glm::dvec3 v = corner[2] - corner[0];
  if (std::max(glm::length(u), glm::length(v)) > 10.0 * kReach) {
    const glm::dvec3 near = kReach * verify::point_in_cube(random);
    const glm::dvec3 normal = glm::normalize(glm::cross(u, v));
    return near - glm::dot(near - corner[0], normal) * normal;
  }
  double a = random.unit();
  double b = mode == 1 ? 0.0 : random.unit();
  if (mode == 2) b = 1.0 - a;
  if (a + b > 1.0) {
    a = 1.0 - a;
    b = 1.0 - b;
  }
  return corner[0] + a * u + b * v;
}

inline glm::dvec3 point_on_cone(const scenes::Cone& cone, Random& random) {
  const glm::dvec3 base(cone.base);
  const glm::dvec3 axis = glm::dvec3(cone.apex) - base;
  const double s = std::array<double, 4>{0.0, 1.0, random.unit(), random.unit()}[random.below(4)];
  const double radius = cone.base_radius + s * (double{cone.apex_radius} - cone.base_radius);
  const glm::dvec3 across = glm::cross(axis, unit_vector(random));
  const double length = glm::length(across);
  if (length == 0.0) return base;
  return base + s * axis + radius / length * across;
}

inline glm::dvec3 point_on(const scenes::Scene& scene, scenes::PrimitiveId id, Random& random) {
  const scenes::Primitive& primitive = scene.primitives[id];
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere: {
      const scenes::Sphere& sphere = scene.spheres[primitive.index];
      return glm::dvec3(sphere.center) + double{sphere.radius} * unit_vector(random);
    }
    case scenes::PrimitiveKind::kCone:
      return point_on_cone(scene.cones[primitive.index], random);
    case scenes::PrimitiveKind::kPolygon:
      break;
  }
  const scenes::Polygon& polygon = scene.polygons[primitive.index];
  const scenes::Triangle& triangle =
      scene.triangles[polygon.first_triangle + random.below(polygon.triangle_count)];
  return point_on_triangle({glm::dvec3(scene.vertices[triangle.vertex[0]]),
                            glm::dvec3(scene.vertices[triangle.vertex[1]]),
                            glm::dvec3(scene.vertices[triangle.vertex[2]])},
                           random);
}

/// Moves a point by up to several hundred times K u, or not at all.
inline glm::dvec3 jittered(const glm::dvec3& point, Random& random) {
  if (random.below(2) == 0) return point;
  const double unit = 16.0 * 0x1p-24 * (1.0 + 2.0 * largest(glm::abs(point)));
  return point + unit * log_uniform(-7, 7, random) * unit_vector(random);
}

/// Returns a point on the primitive; for a sphere, sometimes a point beside the silhouette seen
/// from the origin.
inline glm::dvec3 target_on(const scenes::Scene& scene, scenes::PrimitiveId id,
                            const glm::dvec3& origin, Random& random) {
  const scenes::Primitive& primitive = scene.primitives[id];
  if (primitive.kind == scenes::PrimitiveKind::kSphere && random.below(3) == 0) {
    const scenes::Sphere& sphere = scene.spheres[primitive.index];
    const glm::dvec3 center(sphere.center);
    const double distance = glm::length(center - origin);
    const double radius = sphere.radius;
    if (distance > radius * 1.01) {
      const glm::dvec3 toward = (center - origin) / distance;
      const glm::dvec3 aside = glm::normalize(glm::cross(toward, unit_vector(random)));
      const double sine = radius / distance;
      const double cosine = std::sqrt(1.0 - sine * sine);
      return jittered(center + radius * (cosine * aside - sine * toward), random);
    }
  }
  return jittered(point_on(scene, id, random), random);
}

inline glm::vec3 start_of(const scenes::Scene& scene, scenes::PrimitiveId target,
                          RayStyle::Start start, Random& random) {
  if (start == RayStyle::Start::kAny) start = static_cast<RayStyle::Start>(random.below(3));
  switch (start) {
    case RayStyle::Start::kOnSurface: {
      const auto from = static_cast<scenes::PrimitiveId>(random.below(scene.primitives.size()));
      glm::vec3 point(point_on(scene, from, random));
      if (random.below(3) == 0) {  // a few units in the last place to the side
        const int axis = static_cast<int>(random.below(3));
        for (std::uint64_t i = random.below(4); i > 0; --i) {
          point[axis] = std::nextafter(point[axis], random.below(2) == 0 ? -1e9F : 1e9F);
        }
      }
      return point;
    }
    case RayStyle::Start::kInPlane:
      return glm::vec3(jittered(
          2.0 * point_on(scene, target, random) - point_on(scene, target, random), random));
    default: {
      const glm::dvec3 middle =
          std::abs(scene.bounds.lower.x) > 100.0F
              ? glm::dvec3(0.0)
              : 0.5 * (glm::dvec3(scene.bounds.lower) + glm::dvec3(scene.bounds.upper));
      const glm::dvec3 point = middle + kReach * verify::point_in_cube(random);
      return glm::vec3(random.below(3) == 0 ? snapped(point) : point);
    }
  }
}

/// Multiplies the direction by a power of two, so that its longest component is from 1e-30 to 1e9,
/// and keeps the end of the ray in place; sometimes sets one component to a smaller size.
inline void set_any_size(accel::Ray& ray, Random& random) {
  if (random.below(6) == 0) {
    ray.direction[static_cast<int>(random.below(3))] =
        static_cast<float>(log_uniform(-149, 0, random));
  }
  const glm::dvec3 wide(ray.direction);
  int exponent = 0;
  std::frexp(largest(glm::abs(wide)), &exponent);
  const int power = -98 + static_cast<int>(random.below(128)) - exponent;
  for (int axis = 0; axis < 3; ++axis) {
    ray.direction[axis] = static_cast<float>(std::ldexp(wide[axis], power));
  }
  ray.t_max = static_cast<float>(std::ldexp(double{ray.t_max}, -power));
}

/// Sets an end of the ray to the t of one of its crossings, or close to it.
inline void end_at_own_t(const std::vector<Solid>& solids, accel::Ray& ray, Random& random) {
  const ExactRay exact(ray);
  const std::vector<Crossing> crossings = crossings_of(solids, exact);
  std::vector<const Crossing*> ahead;
  for (const Crossing& crossing : crossings) {
    if (exact.contains(crossing.at)) ahead.push_back(&crossing);
  }
  if (ahead.empty()) return;
  const Crossing& chosen = *ahead[random.below(std::min<std::size_t>(ahead.size(), 3))];
  auto t = static_cast<float>(exact.t_of(chosen.at.rounded()));
  switch (random.below(3)) {
    case 0:
      break;
    case 1:
      for (std::uint64_t i = random.below(4); i > 0; --i) {
        t = std::nextafter(t, random.below(2) == 0 ? 0.0F : accel::kInfinity);
      }
      break;
    default:
      t *= static_cast<float>(1.0 +
                              log_uniform(-24, -10, random) * (random.below(2) == 0 ? -1.0 : 1.0));
  }
  if (!std::isfinite(t)) return;
  (random.below(3) == 0 ? ray.t_min : ray.t_max) = std::max(t, 0.0F);
}

inline accel::Ray claim_ray(const scenes::Scene& scene, const std::vector<Solid>& solids,
                            const RayStyle& style, Random& random) {
  for (;;) {
    accel::Ray ray;
    const auto target = static_cast<scenes::PrimitiveId>(random.below(scene.primitives.size()));
    ray.origin = start_of(scene, target, style.start, random);
    ray.direction = glm::vec3(target_on(scene, target, glm::dvec3(ray.origin), random) -
                              glm::dvec3(ray.origin));
    if (random.below(8) == 0) ray.direction[static_cast<int>(random.below(3))] = 0.0F;
    if (random.below(8) == 0) ray.direction *= static_cast<float>(random.uniform(0.1, 3.0));
    if (largest(glm::abs(glm::dvec3(ray.direction))) < 1e-12) continue;
    const RayStyle::Limits limits = style.limits == RayStyle::Limits::kAny && random.below(2) == 0
                                        ? static_cast<RayStyle::Limits>(random.below(3))
                                        : style.limits;
    if (limits == RayStyle::Limits::kSegment) ray.t_max = 1.0F;
    if (style.all_exponents || random.below(6) == 0) set_any_size(ray, random);
    if (limits == RayStyle::Limits::kOwnT) end_at_own_t(solids, ray, random);
    return ray;
  }
}

}  // namespace beambench::exact

#include "harness/rays/ray_generators.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "accel/core/primary_rays.hpp"
#include "accel/embree/oracle.hpp"
#include "harness/rays/normal.hpp"
#include "scenes/core/random.hpp"

namespace beambench::rays {
namespace {

using glm::dvec3;

PrimaryHitPoint point_of(const scenes::Scene& scene, const accel::Ray& ray,
                         const accel::embree::ExactHit& hit) {
  const dvec3 direction(ray.direction);
  return {dvec3(ray.origin) + hit.t * direction,
          geometric_normal(scene, ray, {static_cast<float>(hit.t), hit.primitive}),
          glm::normalize(direction)};
}

dvec3 above(const scenes::Scene& scene, const PrimaryHitPoint& at) {
  return beside_surface(scene, at.point, at.normal);
}

accel::Ray ray_from(const scenes::Scene& scene, const PrimaryHitPoint& at, const dvec3& direction) {
  accel::Ray ray;
  ray.origin = glm::vec3(above(scene, at));
  ray.direction = glm::vec3(direction);
  return ray;
}

/// A unit vector with density cos / pi in the hemisphere about the unit vector `normal` (Malley's
/// method: a uniform point of the unit disc, lifted to the hemisphere; Pharr, Jakob and Humphreys,
/// Physically Based Rendering, 4th ed., A.5.3).
dvec3 cosine_direction(const dvec3& normal, Random& random) {
  const dvec3 axis = std::abs(normal.x) < 0.5 ? dvec3(1.0, 0.0, 0.0) : dvec3(0.0, 1.0, 0.0);
  const dvec3 tangent = glm::normalize(glm::cross(normal, axis));
  const double radius_2 = random.unit();
  const double radius = std::sqrt(radius_2);
  const double angle = 2.0 * std::numbers::pi * random.unit();
  return tangent * (radius * std::cos(angle)) +
         glm::cross(normal, tangent) * (radius * std::sin(angle)) +
         normal * std::sqrt(1.0 - radius_2);
}

struct Box {
  dvec3 lower;
  dvec3 size;
};

Box widened(const scenes::Bounds& bounds) {
  const dvec3 size = dvec3(bounds.upper) - dvec3(bounds.lower);
  const double diagonal = glm::length(size);
  const double pad = diagonal > 0.0 ? 0x1p-10 * diagonal : 1.0;
  return {dvec3(bounds.lower) - pad, size + 2.0 * pad};
}

/// Enters through one of the six faces, chosen by area.
accel::Ray line_through(const Box& box, Random& random) {
  const dvec3 areas(box.size.y * box.size.z, box.size.z * box.size.x, box.size.x * box.size.y);
  const double chosen = random.uniform(0.0, areas.x + areas.y + areas.z);
  const int axis = chosen < areas.x ? 0 : chosen < areas.x + areas.y ? 1 : 2;
  const bool upper = random.below(2) == 1;

  dvec3 point = box.lower;
  for (int i = 0; i < 3; ++i) point[i] += box.size[i] * random.unit();
  point[axis] = box.lower[axis] + (upper ? box.size[axis] : 0.0);
  dvec3 inward(0.0);
  inward[axis] = upper ? -1.0 : 1.0;
  const dvec3 direction = cosine_direction(inward, random);

  accel::Ray ray;
  ray.origin = glm::vec3(point - direction * glm::length(box.size));
  ray.direction = glm::vec3(direction);
  return ray;
}

}  // namespace

std::vector<PrimaryHitPoint> surface_points(const scenes::Scene& scene,
                                            const accel::PrimaryRays& rays) {
  const accel::embree::EmbreeOracle oracle(scene, glm::length(dvec3(rays.eye())));
  std::vector<std::vector<PrimaryHitPoint>> rows(static_cast<std::size_t>(rays.height()));
  tbb::parallel_for(0, rays.height(), [&](int y) {
    rays.for_each(y, y + 1, [&](std::size_t, const accel::Ray& ray) {
      const std::optional<accel::embree::ExactHit> hit = oracle.closest_hit(ray);
      if (hit) rows[static_cast<std::size_t>(y)].push_back(point_of(scene, ray, *hit));
    });
  });
  std::vector<PrimaryHitPoint> points;
  for (const auto& row : rows) points.insert(points.end(), row.begin(), row.end());
  return points;
}

std::vector<accel::Ray> shadow_rays(const scenes::Scene& scene,
                                    const std::vector<PrimaryHitPoint>& points) {
  std::vector<accel::Ray> rays;
  for (const PrimaryHitPoint& at : points) {
    for (const scenes::Light& light : scene.lights) {
      const dvec3 to_light = dvec3(light.position) - above(scene, at);
      if (glm::dot(to_light, at.normal) <= 0.0) continue;
      rays.push_back(ray_from(scene, at, to_light));
      rays.back().t_max = 1.0F;
    }
  }
  return rays;
}

std::vector<accel::Ray> reflection_rays(const scenes::Scene& scene,
                                        const std::vector<PrimaryHitPoint>& points) {
  std::vector<accel::Ray> rays;
  rays.reserve(points.size());
  for (const PrimaryHitPoint& at : points) {
    rays.push_back(ray_from(scene, at, accel::mirrored(at.incoming, at.normal)));
  }
  return rays;
}

std::vector<accel::Ray> diffuse_rays(const scenes::Scene& scene,
                                     const std::vector<PrimaryHitPoint>& points,
                                     std::uint64_t seed) {
  Random random(seed);
  std::vector<accel::Ray> rays;
  rays.reserve(points.size());
  for (const PrimaryHitPoint& at : points) {
    rays.push_back(ray_from(scene, at, cosine_direction(at.normal, random)));
  }
  return rays;
}

std::vector<accel::Ray> random_rays(const scenes::Bounds& box, std::size_t count,
                                    std::uint64_t seed) {
  std::vector<accel::Ray> rays;
  if (box.empty()) return rays;
  const Box around = widened(box);
  Random random(seed);
  rays.reserve(count);
  while (rays.size() < count) rays.push_back(line_through(around, random));
  return rays;
}

}  // namespace beambench::rays

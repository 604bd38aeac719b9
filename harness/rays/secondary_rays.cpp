#include "harness/rays/secondary_rays.hpp"

#include <optional>

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "accel/core/mirrored.hpp"
#include "accel/embree/oracle.hpp"
#include "harness/rays/beside_surface.hpp"
#include "harness/rays/cosine_direction.hpp"
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

}  // namespace

std::vector<PrimaryHitPoint> surface_points(const scenes::Scene& scene,
                                            const accel::PrimaryRays& rays) {
  const accel::embree::EmbreeOracle oracle(scene, glm::length(dvec3(rays.eye())));
  std::vector<std::vector<PrimaryHitPoint>> rows(static_cast<std::size_t>(rays.height()));
  tbb::parallel_for(0, rays.height(), [&](int y) {
    for (int x = 0; x < rays.width(); ++x) {
      for (int sample = 0; sample < rays.samples(); ++sample) {
        const accel::Ray ray = rays.ray(x, y, sample);
        const std::optional<accel::embree::ExactHit> hit = oracle.closest_hit(ray);
        if (hit) rows[static_cast<std::size_t>(y)].push_back(point_of(scene, ray, *hit));
      }
    }
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

}  // namespace beambench::rays

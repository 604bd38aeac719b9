#include "tests/spd_rays.hpp"

#include <glm/geometric.hpp>

#include "accel/core/primary_rays.hpp"
#include "accel/octree/samet.hpp"

namespace beambench::tests {

namespace {

glm::dvec3 normal_of(const scenes::Scene& scene, scenes::PrimitiveId id) {
  const scenes::Polygon& polygon = scene.polygons[scene.primitives[id].index];
  const auto& corner = scene.triangles[polygon.first_triangle].vertex;
  const glm::dvec3 first(scene.vertices[corner[0]]);
  return glm::cross(glm::dvec3(scene.vertices[corner[1]]) - first,
                    glm::dvec3(scene.vertices[corner[2]]) - first);
}

void add_shadow_rays(const scenes::Scene& scene, const accel::Ray& eye, const accel::Hit& hit,
                     std::vector<accel::Ray>& shadow) {
  constexpr float kAwayFromTheSurface = 1e-5F;  // of the way to the light
  const glm::dvec3 direction(eye.direction);
  const glm::dvec3 point = glm::dvec3(eye.origin) + direction * static_cast<double>(hit.t);
  glm::dvec3 normal = normal_of(scene, hit.primitive);
  if (glm::dot(normal, direction) > 0.0) normal = -normal;
  for (const scenes::Light& light : scene.lights) {
    const glm::dvec3 to_light = glm::dvec3(light.position) - point;
    if (glm::dot(normal, to_light) <= 0.0) continue;
    shadow.push_back({glm::vec3(point), kAwayFromTheSurface, glm::vec3(to_light), 1.0F});
  }
}

}  // namespace

SpdRays spd_rays(const scenes::Scene& scene) {
  constexpr int kPixels = 512;
  SpdRays rays;
  const accel::PrimaryRays image(scene.cameras.front(), kPixels, kPixels, 1);
  const accel::octree::Samet finder(scene, {});
  for (int y = 0; y <= kPixels; ++y) {
    for (int x = 0; x <= kPixels; ++x) {
      const accel::Ray eye = image.ray_at(x, y);
      rays.eye.push_back(eye);
      const auto hit = finder.closest_hit(eye, nullptr);
      if (!hit) continue;
      ++rays.eye_hits;
      add_shadow_rays(scene, eye, *hit, rays.shadow);
    }
  }
  return rays;
}

}  // namespace beambench::tests

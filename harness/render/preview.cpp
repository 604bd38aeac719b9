#include "harness/render/preview.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "harness/rays/normal.hpp"
#include "harness/render/phong.hpp"
#include "harness/render/picture/srgb.hpp"

namespace beambench::render {
namespace {

// Shares of the light on a surface that faces the eye and the lights: they add up to 1.
constexpr double kAmbient = 0.06;
constexpr double kHeadlight = 0.24;
constexpr double kLights = 0.70;
constexpr double kHighlight = 0.35;  // on top, of a fully specular surface
constexpr double kMaxShine = 200.0;

glm::vec3 display_to_linear(const glm::vec3& color) {
  return linear_from_srgb(glm::clamp(color, 0.0F, 1.0F));
}

/// What the lights send to the eye, in parts of white.
struct Reflected {
  glm::dvec3 matte{0.0};
  glm::dvec3 glossy{0.0};
};

Reflected reflect_lights(const scenes::Scene& scene, const glm::dvec3& point,
                         const glm::dvec3& normal, const glm::dvec3& to_eye, float shine) {
  Reflected sum;
  if (scene.lights.empty()) {
    sum.matte = glm::dvec3(std::max(glm::dot(normal, to_eye), 0.0));
    return sum;
  }
  const double share = 1.0 / std::sqrt(static_cast<double>(scene.lights.size()));
  for (const scenes::Light& light : scene.lights) {
    const glm::dvec3 way = glm::dvec3(light.position) - point;
    const double distance = glm::length(way);
    if (distance == 0.0) continue;
    const glm::dvec3 to_light = way / distance;
    const double cosine = glm::dot(normal, to_light);
    if (cosine <= 0.0) continue;
    const glm::dvec3 power = share * glm::dvec3(glm::clamp(light.color, 0.0F, 1.0F));
    sum.matte += power * cosine;
    sum.glossy += power * phong(normal, to_light, to_eye, std::min(double{shine}, kMaxShine));
  }
  return sum;
}

}  // namespace

glm::vec3 preview_color(const scenes::Scene& scene, const accel::Ray& ray, const accel::Hit& hit) {
  const scenes::Surface& surface = scene.surfaces[scene.primitives[hit.primitive].surface];
  const glm::dvec3 direction(ray.direction);
  const glm::dvec3 point = glm::dvec3(ray.origin) + double{hit.t} * direction;
  const glm::dvec3 normal = rays::shading_normal(scene, ray, hit);
  const glm::dvec3 to_eye = -glm::normalize(direction);

  const Reflected lights = reflect_lights(scene, point, normal, to_eye, surface.shine);
  const double headlight = std::max(glm::dot(normal, to_eye), 0.0);
  const glm::dvec3 matte = kAmbient + kHeadlight * headlight + kLights * lights.matte;
  const glm::dvec3 glossy = kHighlight * double{std::min(surface.specular, 1.0F)} * lights.glossy;
  const glm::dvec3 color(display_to_linear(surface.color));
  return {color * matte + glossy};
}

glm::vec3 background_color(const scenes::Scene& scene) {
  return display_to_linear(scene.background);
}

}  // namespace beambench::render

#include "harness/render/shading.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "harness/base/messages.hpp"
#include "harness/rays/normal.hpp"
#include "harness/render/picture/color.hpp"

namespace beambench::render {
namespace {

// Shares of the light on a surface that faces the camera and the lights: they add up to 1.
constexpr double kAmbient = 0.06;
constexpr double kHeadlight = 0.24;
constexpr double kLights = 0.70;
constexpr double kHighlight = 0.35;  // added on top, for a fully specular surface
constexpr double kMaxShine = 200.0;

glm::vec3 display_to_linear(const glm::vec3& color) {
  return linear_from_srgb(glm::clamp(color, 0.0F, 1.0F));
}

/// The light reflected to the camera, relative to white.
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
    const glm::dvec3 offset = glm::dvec3(light.position) - point;
    const double distance = glm::length(offset);
    if (distance == 0.0) continue;
    const glm::dvec3 to_light = offset / distance;
    const double cosine = glm::dot(normal, to_light);
    if (cosine <= 0.0) continue;
    const glm::dvec3 power = share * glm::dvec3(glm::clamp(light.color, 0.0F, 1.0F));
    sum.matte += power * cosine;
    sum.glossy += power * phong(normal, to_light, to_eye, std::min(double{shine}, kMaxShine));
  }
  return sum;
}

constexpr std::array<std::string_view, 5> kShadingNames{"preview", "normals", "id", "depth",
                                                        "whitted"};

using HitColor = std::function<glm::vec3(const accel::Ray&, const accel::Hit&)>;

glm::vec3 normal_color(const scenes::Scene& scene, const accel::Ray& ray, const accel::Hit& hit) {
  return linear_from_srgb(glm::vec3(rays::geometric_normal(scene, ray, hit) * 0.5 + 0.5));
}

/// Returns light gray at the nearest hit of the image, dark gray at the farthest; black for a miss.
HitColor depth_color(const accel::HitBuffer& hits) {
  float nearest = accel::kInfinity;
  float farthest = 0.0F;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (const auto hit = hits.get(i)) {
      nearest = std::min(nearest, hit->t);
      farthest = std::max(farthest, hit->t);
    }
  }
  const float range = farthest > nearest ? farthest - nearest : 1.0F;
  return [nearest, range](const accel::Ray&, const accel::Hit& hit) {
    return linear_from_srgb(glm::vec3(0.95F - 0.80F * (hit.t - nearest) / range));
  };
}

HitColor color_of(const scenes::Scene& scene, const accel::HitBuffer& hits, Shading shading) {
  switch (shading) {
    case Shading::kPreview:
      return [&](const accel::Ray& ray, const accel::Hit& hit) {
        return preview_color(scene, ray, hit);
      };
    case Shading::kNormals:
      return [&](const accel::Ray& ray, const accel::Hit& hit) {
        return normal_color(scene, ray, hit);
      };
    case Shading::kId:
      return [](const accel::Ray&, const accel::Hit& hit) { return id_color(hit.primitive); };
    case Shading::kDepth:
      return depth_color(hits);
    case Shading::kWhitted:
      break;
  }
  throw std::invalid_argument("shade() has hits only; Whitted traces more rays");
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

std::span<const std::string_view> shading_names() { return kShadingNames; }

Shading parse_shading(std::string_view name) {
  return static_cast<Shading>(base::place_of_name("shading", name, kShadingNames));
}

Image shade(const scenes::Scene& scene, const accel::PrimaryRays& rays,
            const accel::HitBuffer& hits, Shading shading) {
  const HitColor hit_color = color_of(scene, hits, shading);
  const glm::vec3 miss = shading == Shading::kPreview ? background_color(scene) : glm::vec3(0.0F);
  const auto samples = static_cast<std::size_t>(rays.samples());
  const float share = 1.0F / static_cast<float>(samples);
  Image image(rays.width(), rays.height());
  rays.for_each(0, rays.height(), [&](std::size_t index, const accel::Ray& ray) {
    const auto hit = hits.get(index);
    image.pixels()[index / samples] += share * (hit ? hit_color(ray, *hit) : miss);
  });
  return image;
}

}  // namespace beambench::render

#include "harness/render/shading.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/rays/normal.hpp"
#include "harness/render/picture/color_map.hpp"
#include "harness/render/picture/srgb.hpp"
#include "harness/render/preview.hpp"
#include "scenes/core/error.hpp"

namespace beambench::render {
namespace {

constexpr std::array<std::string_view, 5> kNames{"preview", "normals", "id", "depth", "whitted"};

using HitColor = std::function<glm::vec3(const accel::Ray&, const accel::Hit&)>;

glm::vec3 normal_color(const scenes::Scene& scene, const accel::Ray& ray, const accel::Hit& hit) {
  return linear_from_srgb(glm::vec3(rays::geometric_normal(scene, ray, hit) * 0.5 + 0.5));
}

/// Light gray at the nearest hit of the image, dark gray at the farthest; black is a miss.
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

std::span<const std::string_view> shading_names() { return kNames; }

Shading parse_shading(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) {
    throw InputError(
        fmt::format("unknown shading '{}'; choose from: {}", name, fmt::join(kNames, ", ")));
  }
  return static_cast<Shading>(found - kNames.begin());
}

Image shade(const scenes::Scene& scene, const accel::PrimaryRays& rays,
            const accel::HitBuffer& hits, Shading shading) {
  const HitColor hit_color = color_of(scene, hits, shading);
  const glm::vec3 miss = shading == Shading::kPreview ? background_color(scene) : glm::vec3(0.0F);
  const float share = 1.0F / static_cast<float>(rays.samples());
  Image image(rays.width(), rays.height());
  for (int y = 0; y < rays.height(); ++y) {
    for (int x = 0; x < rays.width(); ++x) {
      for (int sample = 0; sample < rays.samples(); ++sample) {
        const auto hit = hits.get(hits.index(x, y, sample));
        image.at(x, y) += share * (hit ? hit_color(rays.ray(x, y, sample), *hit) : miss);
      }
    }
  }
  return image;
}

}  // namespace beambench::render

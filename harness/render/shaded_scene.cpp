#include "harness/render/shaded_scene.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

#include "harness/rays/lights.hpp"
#include "harness/render/picture/color.hpp"
#include "harness/render/shading.hpp"

namespace beambench::render {
namespace {

using glm::dvec3;

/// Returns the matte color for a display color.
dvec3 matte(const scenes::Surface& surface, const dvec3& color) {
  const dvec3 display = glm::clamp(color, 0.0, 1.0);
  return double{surface.diffuse} * dvec3(linear_from_srgb(glm::vec3(display)));
}

}  // namespace

ShadedScene::ShadedScene(const scenes::Scene& scene)
    : scene_(&scene),
      textures_(scene),
      light_colors_(rays::light_colors(scene)),
      normals_(scene),
      mirrors_(scene),
      glass_(scene, scenes::planar_glass(scene)),
      background_(background_color(scene)) {
  for (const scenes::Surface& surface : scene.surfaces) {
    auto& known = matte_.emplace_back();
    if (!is_texture(surface.finish)) known = matte(surface, dvec3(surface.color));
  }
}

dvec3 ShadedScene::matte_at(std::uint32_t surface, const dvec3& point) const {
  if (const auto& known = matte_[surface]) return *known;
  const scenes::Surface& textured = scene_->surfaces[surface];
  return matte(textured, textures_.color_at(textured, point));
}

}  // namespace beambench::render

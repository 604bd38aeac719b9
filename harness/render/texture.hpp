#pragma once
// The colors of the thesis's textures in space.

#include <glm/vec3.hpp>

#include "scenes/scene.hpp"

namespace beambench::render {

/// Textures fill space, so that every scene may have them: veins and rings are measured in parts of
/// the scene.
class TextureSpace {
 public:
  explicit TextureSpace(const scenes::Scene& scene);

  /// The display color of a surface at a point of the scene: its own where its finish is not a
  /// texture.
  glm::dvec3 color_at(const scenes::Surface& surface, const glm::dvec3& point) const;

 private:
  glm::dvec3 middle_{0.0};
  double scale_ = 1.0;
};

}  // namespace beambench::render

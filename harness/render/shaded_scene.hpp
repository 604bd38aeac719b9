#pragma once
// Data of a scene for shading, computed once for all its pictures.

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "harness/rays/normal.hpp"
#include "harness/rays/virtual_eye.hpp"
#include "harness/render/texture.hpp"
#include "scenes/scene.hpp"

namespace beambench::render {

/// Data for shading a scene, which must outlive this object.
class ShadedScene {
 public:
  explicit ShadedScene(const scenes::Scene& scene);

  const scenes::Scene& scene() const { return *scene_; }
  /// Returns linear light. A light without a stated color is white, with intensity 1 /
  /// sqrt(lights).
  const std::vector<glm::dvec3>& light_colors() const { return light_colors_; }
  const glm::dvec3& background() const { return background_; }
  const rays::NormalTable& normals() const { return normals_; }
  const rays::MirrorTable& mirrors() const { return mirrors_; }
  const rays::PlaneTable& glass() const { return glass_; }
  /// Returns a surface's color times its diffuse factor at a point of the scene, in linear light.
  glm::dvec3 matte_at(std::uint32_t surface, const glm::dvec3& point) const;

 private:
  const scenes::Scene* scene_;
  TextureSpace textures_;
  std::vector<glm::dvec3> light_colors_;
  rays::NormalTable normals_;
  rays::MirrorTable mirrors_;
  rays::PlaneTable glass_;
  std::vector<std::optional<glm::dvec3>> matte_;  ///< by surface; nothing if it has a texture
  glm::dvec3 background_;
};

}  // namespace beambench::render

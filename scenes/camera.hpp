#pragma once
// The pinhole camera of a scene.

#include <string>

#include <glm/vec3.hpp>

namespace beambench::scenes {

/// A pinhole camera. It defines the frustum; a resolution only samples the frustum (with non-square
/// pixels if its aspect differs), so that sweeps over resolutions use the same image.
struct Camera {
  std::string name = "default";
  glm::vec3 from{0.0F, 0.0F, 0.0F};
  glm::vec3 at{0.0F, 0.0F, -1.0F};
  glm::vec3 up{0.0F, 1.0F, 0.0F};
  float angle = 45.0F;  ///< full vertical field of view in degrees, in (0, 180)
  float aspect = 1.0F;  ///< width of the frustum over its height, > 0
  float hither = 0.0F;  ///< NFF's near distance; kept for export, rays start at the eye
  int width = 512;      ///< the scene's suggested resolution in pixels
  int height = 512;
};

}  // namespace beambench::scenes

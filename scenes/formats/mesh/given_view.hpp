#pragma once
// Cameras and lights that a person chose for a mesh.

#include <vector>

#include <glm/vec3.hpp>

#include "scenes/camera.hpp"

namespace beambench::scenes::mesh {

/// How a person chose to look at a mesh, where one did. Of a closed interior, everything that is
/// fitted to the mesh would be outside of its walls.
struct GivenView {
  std::vector<Camera> cameras;
  std::vector<glm::dvec3> lights;  ///< all white and of one strength
};

}  // namespace beambench::scenes::mesh

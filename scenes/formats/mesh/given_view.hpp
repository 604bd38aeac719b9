#pragma once
// Cameras and lights that a mesh comes with.

#include <vector>

#include "scenes/camera.hpp"
#include "scenes/scene.hpp"

namespace beambench::scenes::mesh {

/// How a mesh is looked at, as a person chose or its file says. Of a closed interior, everything
/// that is fitted to the mesh would be outside of its walls.
struct GivenView {
  std::vector<Camera> cameras;
  std::vector<Light> lights;
};

}  // namespace beambench::scenes::mesh

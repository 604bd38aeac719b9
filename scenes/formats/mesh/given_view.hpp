#pragma once
// Cameras and lights supplied with a mesh.

#include <vector>

#include "scenes/camera.hpp"
#include "scenes/scene.hpp"

namespace beambench::scenes::mesh {

/// The view of a mesh chosen by a person or stated in its file. Needed for closed interiors,
/// because a camera or light fitted to the mesh would lie outside its walls.
struct GivenView {
  std::vector<Camera> cameras;
  std::vector<Light> lights;
};

}  // namespace beambench::scenes::mesh

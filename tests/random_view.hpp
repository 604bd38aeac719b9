#pragma once
// Random eye positions for tests of images.

#include <algorithm>

#include "scenes/base/random.hpp"
#include "scenes/scene.hpp"

namespace beambench::tests {

/// Sets `from` and `at` of a camera outside, inside or in the middle planes of the scene's box,
/// with a random direction.
inline scenes::Camera random_view(const scenes::Scene& scene, Random& random) {
  const glm::vec3 middle = 0.5F * (scene.bounds.lower + scene.bounds.upper);
  const glm::vec3 size = scene.bounds.upper - scene.bounds.lower;
  const float reach = std::max({size.x, size.y, size.z, 1e-3F});
  const float spread = random.below(2) == 0 ? 0.4F : 2.5F;
  scenes::Camera camera;
  for (int axis = 0; axis < 3; ++axis) {
    camera.from[axis] = middle[axis];
    if (random.below(4) != 0) {
      camera.from[axis] += reach * static_cast<float>(random.uniform(-spread, spread));
    }
    camera.at[axis] = middle[axis];
    if (random.below(4) != 0) {
      camera.at[axis] += reach * static_cast<float>(random.uniform(-0.5, 0.5));
    }
  }
  if (camera.from == camera.at) camera.at.x += reach;
  return camera;
}

}  // namespace beambench::tests

#pragma once
// Scenes and rays made to fall between the boxes and cells of a structure.

#include <vector>

#include "accel/ray.hpp"
#include "harness/selftest/primitive_kinds.hpp"
#include "scenes/scene.hpp"

namespace beambench {

struct SceneWithRays {
  Scene scene;
  std::vector<Ray> rays;
};

/// Cubes on a lattice whose planes are those of cells: rays along axes and diagonals, from outside
/// and inside, run in faces and through edges and vertices.
SceneWithRays cubes_on_a_lattice();

/// A block of squares: rays within the faces and along the edges of every box there is, the
/// directions' zeros of both signs.
SceneWithRays block_of_squares();

/// Ten thousand equal spheres in one place, or cones or triangles where only these are wanted: no
/// split parts them, and the lowest id is hit.
SceneWithRays heap(PrimitiveKinds kinds);

/// Nothing; then one sphere, one cone, one triangle whose bounds have no volume.
std::vector<Scene> smallest_scenes();

/// Directions of all lengths, the longest 2^60 times the shortest, and nearly along an axis; rays
/// of no length; rays that end before they begin.
std::vector<Ray> degenerate_rays(const Scene& scene, std::uint64_t seed);

}  // namespace beambench

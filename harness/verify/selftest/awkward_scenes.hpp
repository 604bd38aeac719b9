#pragma once
// Scenes and rays made to fall between the boxes and cells of a structure.

#include <vector>

#include "accel/core/ray.hpp"
#include "harness/verify/selftest/primitive_kinds.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

struct SceneWithRays {
  scenes::Scene scene;
  std::vector<accel::Ray> rays;
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
std::vector<scenes::Scene> smallest_scenes();

/// Directions of all lengths, the longest 2^60 times the shortest, and nearly along an axis; rays
/// of no length; rays that end before they begin.
std::vector<accel::Ray> degenerate_rays(const scenes::Scene& scene, std::uint64_t seed);

}  // namespace beambench::verify

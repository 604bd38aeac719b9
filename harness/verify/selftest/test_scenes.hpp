#pragma once
// Scenes and rays that look for trouble: ties, shared edges, boundaries, inner surfaces.

#include <cstdint>
#include <vector>

#include "accel/core/ray.hpp"
#include "harness/verify/selftest/subject.hpp"
#include "scenes/core/random.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// A scene of spheres, triangles, concave polygons and cones in and around the cube [-1, 1]^3. Of
/// every four seeds one gives coordinates that are multiples of 1/8 (coplanar polygons, shared
/// edges and exact ties), one repeats primitives, one lies far from the origin of the coordinates.
/// `kinds` leaves some kinds of primitives out.
scenes::Scene random_scene(std::uint64_t seed, int primitives, PrimitiveKinds kinds = {});

/// A ray from outside, inside or a special place (the scene's center planes, axes and center, which
/// are faces, edges and corners of octree cells; a vertex), in any direction, along an axis or a
/// diagonal, or aimed at a vertex, an edge or a primitive's middle; now and then with a short
/// interval.
accel::Ray random_ray(const scenes::Scene& scene, Random& random);

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

#pragma once
// Scenes and rays that look for trouble: ties, shared edges, boundaries, inner surfaces.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "accel/core/ray.hpp"
#include "harness/verify/selftest/subject.hpp"
#include "scenes/base/random.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// Uniform in [-1, 1]^3.
glm::dvec3 point_in_cube(Random& random);

/// A scene of one or more spheres, triangles, concave polygons and cones in and around the cube
/// [-1, 1]^3, fewer than `primitives` where some would be degenerate. Of
/// every four seeds one gives coordinates that are multiples of 1/8 (coplanar polygons, shared
/// edges and exact ties), one repeats primitives, one lies far from the origin of the coordinates.
/// `kinds` leaves some kinds of primitives out.
scenes::Scene random_scene(std::uint64_t seed, int primitives, PrimitiveKinds kinds = {});

/// A ray from outside, inside or a special place (the scene's center planes, axes and center, which
/// are faces, edges and corners of octree cells; a vertex), in any direction, along an axis or a
/// diagonal, or aimed at a vertex, an edge or a primitive's middle; now and then with a short
/// interval.
accel::Ray random_ray(const scenes::Scene& scene, Random& random);

/// So many of them.
std::vector<accel::Ray> random_rays(const scenes::Scene& scene, std::uint64_t count,
                                    Random& random);

/// A camera where such a ray may begin, that looks where it may go, with an angle of 5 to 150
/// degrees.
scenes::Camera random_camera(const scenes::Scene& scene, Random& random);

/// Adds two lights where such rays may begin.
void add_lights(scenes::Scene& scene, Random& random);

/// Does the ray nearly lie in the plane of a polygon, so that places far apart on it are close
/// across the polygon (`kAlong`)? Where it meets that polygon is then decided by rounding alone.
bool is_edge_on(const scenes::Scene& scene, const accel::Ray& ray);

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

/// The families, in the order of the seeds: scene `seed` is of family `seed` % their number.
inline constexpr std::array<std::string_view, 7> kSceneFamilies{
    "flat cones",         // heights down to 1e-9 of the radii, cylinders as flat, in stacks
    "eye on geometry",    // on a sphere, a cone, its rim or tip; on, at the edge or corner of
                          // polygons
    "touching spheres",   // as large as their lattice is wide, and the camera at a contact
    "tiny scale",         // coordinates down to 1e-7: smaller scenes are soon refused
    "coplanar polygons",  // overlapping in one plane, or nearly; now and then the camera is in it
    "needles",            // triangles and cones 1e3 to 1e6 times as long as wide
    "nested",             // spheres, cylinders, boxes in each other, 1e-2 to 1e-6 apart
};

/// A scene of up to 20 primitives with one camera, two lights, and matte, mirroring and transparent
/// surfaces. `kinds` leaves some kinds of primitives out; a family that needs one that is left out
/// makes do with another. The same seed gives the same scene everywhere.
scenes::Scene family_scene(std::uint64_t seed, PrimitiveKinds kinds = {});

}  // namespace beambench::verify

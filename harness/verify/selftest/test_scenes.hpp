#pragma once
// Scenes and rays that provoke errors: ties, shared edges, boundaries, inner surfaces.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "accel/core/ray.hpp"
#include "harness/verify/selftest/subject.hpp"
#include "scenes/base/random.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// Returns a point uniform in [-1, 1]^3.
glm::dvec3 point_in_cube(Random& random);

/// Returns a scene of one or more spheres, triangles, concave polygons and cones in and around the
/// cube [-1, 1]^3, fewer than `primitives` if some would be degenerate. Of every four seeds, one
/// gives coordinates that are multiples of 1/8 (coplanar polygons, shared edges and exact ties),
/// one repeats primitives, and one gives a scene far from the coordinate origin. `kinds` leaves
/// some kinds of primitives out.
scenes::Scene random_scene(std::uint64_t seed, int primitives, PrimitiveKinds kinds = {});

/// Returns a ray from outside, inside or a special place (the scene's center planes, axes and
/// center, which are faces, edges and corners of octree cells; a vertex), in any direction, along
/// an axis or a diagonal, or aimed at a vertex, an edge or a primitive's middle; sometimes with a
/// short interval.
accel::Ray random_ray(const scenes::Scene& scene, Random& random);

/// Returns `count` such rays.
std::vector<accel::Ray> random_rays(const scenes::Scene& scene, std::uint64_t count,
                                    Random& random);

/// Returns a camera that is placed and directed like such a ray, with an angle of 5 to 150 degrees.
scenes::Camera random_camera(const scenes::Scene& scene, Random& random);

/// Adds two lights at places where such rays may begin.
void add_lights(scenes::Scene& scene, Random& random);

/// Returns whether the ray lies so nearly in the plane of a polygon that places far apart on it are
/// close across the polygon (`kAlong`). Its hit on that polygon is then decided by rounding alone.
bool is_edge_on(const scenes::Scene& scene, const accel::Ray& ray);

struct SceneWithRays {
  scenes::Scene scene;
  std::vector<accel::Ray> rays;
};

/// Returns cubes on a lattice whose planes also bound the cells of structures. Rays along axes and
/// diagonals, from outside and inside, run in faces and through edges and vertices.
SceneWithRays cubes_on_a_lattice();

/// Returns a block of squares, and rays within the faces and along the edges of every box, with
/// zeros of both signs in their directions.
SceneWithRays block_of_squares();

/// Returns ten thousand equal spheres in one place, or cones or triangles if only these are
/// allowed: no split separates them, and the lowest id must be hit.
SceneWithRays heap(PrimitiveKinds kinds);

/// Returns an empty scene, then scenes of one sphere, one cone, and one triangle whose bounds have
/// no volume.
std::vector<scenes::Scene> smallest_scenes();

/// Returns directions of all lengths, the longest 2^60 times the shortest, and nearly along an
/// axis; rays of length zero; rays that end before they begin.
std::vector<accel::Ray> degenerate_rays(const scenes::Scene& scene, std::uint64_t seed);

/// The families, in the order of the seeds: scene `seed` belongs to family `seed` % their number.
inline constexpr std::array<std::string_view, 7> kSceneFamilies{
    "flat cones",         // heights down to 1e-9 of the radii, equally flat cylinders, in stacks
    "eye on geometry",    // on a sphere, a cone, its rim or tip; on, at the edge or corner of
                          // polygons
    "touching spheres",   // as wide as the cells of their lattice; the camera may be at a contact
    "tiny scale",         // coordinates down to 1e-7: slightly smaller scenes are refused
    "coplanar polygons",  // overlapping in one plane, or nearly; sometimes the camera is in it
    "needles",            // triangles and cones 1e3 to 1e6 times as long as wide
    "nested",             // spheres, cylinders, boxes nested, 1e-2 to 1e-6 apart
};

/// Returns a scene of up to 20 primitives with one camera, two lights, and matte, mirroring and
/// transparent surfaces. `kinds` leaves some kinds of primitives out; a family that needs one of
/// these uses another kind. The same seed gives the same scene everywhere.
scenes::Scene family_scene(std::uint64_t seed, PrimitiveKinds kinds = {});

}  // namespace beambench::verify

#pragma once
// Random scenes and rays that look for trouble: ties, shared edges, boundaries, inner surfaces.

#include <cstdint>
#include <vector>

#include "accel/core/ray.hpp"
#include "harness/verify/selftest/primitive_kinds.hpp"
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

}  // namespace beambench::verify

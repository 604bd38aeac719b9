#pragma once
// Writes the triangles of a scene as Wavefront OBJ, for programs that only trace triangles.

#include <ostream>

#include "scenes/scene.hpp"

namespace beambench::scenes::mesh {

/// Writes the vertices and triangles in the order of `Scene::vertices` and `Scene::triangles`: the
/// n-th line that begins with f, counted from 0, is triangle n. A polygon with four or more corners
/// becomes several triangles. Numbers are the shortest that a reader rounds to the same float.
/// Throws InputError for a scene with spheres or cones. The stream's state indicates whether
/// writing succeeded.
void write_obj(const Scene& scene, std::ostream& stream);

}  // namespace beambench::scenes::mesh

#pragma once
// Writes the triangles of a scene as Wavefront OBJ, for programs that trace nothing else.

#include <ostream>

#include "scenes/scene.hpp"

namespace beambench::scenes::mesh {

/// Writes the vertices and triangles in the order of `Scene::vertices` and `Scene::triangles`: the
/// face on the n-th line that begins with f, counted from 0, is triangle n. A polygon of four or
/// more corners is several of them. Numbers are as short as is exact for a reader that rounds them
/// to float. Throws InputError for a scene with spheres or cones. The stream's state says whether
/// writing succeeded.
void write_obj(const Scene& scene, std::ostream& stream);

}  // namespace beambench::scenes::mesh

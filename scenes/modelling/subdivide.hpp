#pragma once
// Finer meshes: triangles only, or an exact number of polygons.

#include <cstddef>

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::modelling {

/// Splits every polygon into triangles, quads along their shorter diagonal. The surface of flat
/// polygons stays the same.
PolygonMesh triangulated(const PolygonMesh& mesh);

/// Returns the mesh with exactly `count` polygons. While there are fewer, the largest polygon is
/// split: along a diagonal if it has more than three corners, otherwise at the middle of its
/// longest edge, together with its neighbors at this edge, so that no vertex lies inside an edge. A
/// neighbor merely gets the new vertex as a corner if it is concave or `count` is already reached.
/// Concave polygons are not split. Throws std::invalid_argument if the mesh has more polygons than
/// `count` or no polygon that can be split, or if `count` is beyond 100 million.
PolygonMesh subdivided_to(PolygonMesh mesh, std::size_t count);

}  // namespace beambench::scenes::modelling

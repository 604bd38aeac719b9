#pragma once
// Finer meshes: triangles only, or an exact number of polygons.

#include <cstddef>

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::modelling {

/// Every polygon in triangles, quads along their shorter diagonal. The surface of flat polygons
/// stays the same.
PolygonMesh triangulated(const PolygonMesh& mesh);

/// The mesh with exactly `count` polygons: while there are fewer, the largest is split, one of more
/// than three corners along a diagonal, a triangle at the middle of its longest edge together with
/// its neighbors there, so that no vertex lies inside an edge. Only where one polygon is
/// missing and every split adds two, a neighbor keeps the new vertex as a corner. Concave polygons
/// are left whole. Throws std::invalid_argument when the mesh has more polygons than `count`,
/// none that can be split, or `count` is beyond 100 million.
PolygonMesh subdivided_to(PolygonMesh mesh, std::size_t count);

}  // namespace beambench::scenes::modelling

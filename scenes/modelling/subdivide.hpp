#pragma once
// Finer meshes: triangles only, or an exact number of polygons.

#include <cstddef>

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::modelling {

/// Splits every polygon into triangles, quads along their shorter diagonal. The surface of flat
/// polygons stays the same.
PolygonMesh triangulated(const PolygonMesh& mesh);

/// Returns the mesh with exactly `count` polygons. While there are fewer, the largest is split: a
/// polygon with more than three corners along a diagonal, a triangle at the middle of its longest
/// edge together with its neighbors there, so that no vertex lies inside an edge. A neighbor keeps
/// the new vertex as a corner only if one polygon is missing and every split adds two. Concave
/// polygons are not split. Throws std::invalid_argument if the mesh has more polygons than `count`
/// or none that can be split, or if `count` is beyond 100 million.
PolygonMesh subdivided_to(PolygonMesh mesh, std::size_t count);

}  // namespace beambench::scenes::modelling

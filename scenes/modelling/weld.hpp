#pragma once
// Coincident vertices made one.

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::modelling {

/// Vertices nearer to each other than 1e-9 of the mesh's largest coordinate become one (the first),
/// so that edges are shared. Corners that coincide with the one before are dropped, and polygons
/// left with fewer than three.
PolygonMesh welded(const PolygonMesh& mesh);

}  // namespace beambench::scenes::modelling

#pragma once
// Plates with a square hole.

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::modelling {

/// The square plate |x|, |y| <= half between two heights, with the hole |x|, |y| < hole: 16 quads,
/// four of them on each of outside, top, hole and bottom, in that order for every side.
PolygonMesh square_ring(double half, double hole, double bottom, double top);

}  // namespace beambench::scenes::modelling

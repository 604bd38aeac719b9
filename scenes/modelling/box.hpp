#pragma once
// Straight pieces: boxes, square rings, bars and bracing.

#include <span>

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::modelling {

/// Returns the six faces of the box between two corners, in the order -x, +x, -y, +y, -z, +z.
PolygonMesh box(const glm::dvec3& lower, const glm::dvec3& upper);

/// Returns the box without its lower face (-z), for pieces that stand on something.
PolygonMesh box_without_bottom(const glm::dvec3& lower, const glm::dvec3& upper);

/// Returns the box with its edges cut off by `bevel` on both sides: 6 faces, 12 edges, 8 corner
/// triangles. `bevel` must be positive and less than half of every extent.
PolygonMesh beveled_box(const glm::dvec3& lower, const glm::dvec3& upper, double bevel);

/// Returns the square plate |x|, |y| <= half between two heights, with the hole |x|, |y| < hole: 16
/// quads, four on each side, in the order outside, top, hole, bottom.
PolygonMesh square_ring(double half, double hole, double bottom, double top);

/// Returns a four-sided bar between two points, with two sides facing along `outward`. Its open
/// ends are inside the pieces that it is attached to.
PolygonMesh bar(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& outward,
                double thickness);

/// The bracing of a face between two posts whose points are listed level by level from below. It
/// has a crossbar at every level and two diagonals in every panel. Crossing bars differ in
/// thickness, so that none of their faces are coplanar.
struct Bracing {
  double crossbar;
  double diagonal;
};
PolygonMesh braced_face(std::span<const glm::dvec3> left, std::span<const glm::dvec3> right,
                        const glm::dvec3& outward, const Bracing& bracing);

}  // namespace beambench::scenes::modelling

#pragma once
// An outline swept along a path.

#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::modelling {

/// The ends of a sweep that are closed by a polygon. An end of size 0 is a tip and needs no
/// polygon.
enum class Caps : std::uint8_t { kNone, kStart, kEnd, kBoth };

/// Returns a regular polygon of radius 1, counter-clockwise.
std::vector<glm::dvec2> circle(int sides);

/// Sweeps the outline (counter-clockwise, its x along `side` at the start) along the path without
/// twist (rotation-minimizing frames by double reflection: Wang, Juettler, Zheng and Liu 2008) and
/// scaled by `scales`, one for each path point. Returns a ring of quads between consecutive path
/// points, or of triangles at a tip. `side` is made perpendicular to the path; it must not be
/// parallel to the path's start.
PolygonMesh sweep(std::span<const glm::dvec2> outline, std::span<const glm::dvec3> path,
                  std::span<const double> scales, const glm::dvec3& side, Caps caps);

/// Returns a round tube: a circle of `sides` with a radius at each path point.
PolygonMesh tube(std::span<const glm::dvec3> path, std::span<const double> radii, int sides,
                 Caps caps = Caps::kNone);

/// Returns points on a Catmull-Rom spline through `knots`, with `steps` pieces from knot to knot.
std::vector<glm::dvec3> spline(std::span<const glm::dvec3> knots, int steps);

}  // namespace beambench::scenes::modelling

#pragma once
// Walls with openings (of houses, window frames, paneled doors), and moldings: skirting boards,
// cornices, picture frames.

#include <array>
#include <span>

#include <glm/vec2.hpp>

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::modelling {

struct Rectangle {
  glm::dvec2 lower, upper;
};

/// Returns the rectangle from (0, 0) to `size` in the plane z = 0, facing +z, without the openings,
/// plus the openings' sides down to z = -depth. Openings must not touch one another; an opening
/// that reaches the wall's edge has no side at this edge.
PolygonMesh recessed(const glm::dvec2& size, std::span<const Rectangle> openings, double depth);

/// Returns quads that close the openings, at z = -depth.
PolygonMesh openings_filled(std::span<const Rectangle> openings, double depth);

/// Returns columns x rows equal openings in the rectangle from (0, 0) to `size`, with bars of equal
/// width around each of them.
std::vector<Rectangle> panes(const glm::dvec2& size, int columns, int rows, double bar);

/// Returns a profile of points (inset, z) swept around the rectangle from (0, 0) to `size`, with
/// mitered corners: four quads from each point to the next, along y = 0, x = size.x, y = size.y and
/// x = 0 in that order. The molding faces upward where the profile runs inward.
PolygonMesh molding(const glm::dvec2& size, std::span<const glm::dvec2> profile);

/// Returns the molding without one of the rectangle's sides (0 ... 3, in the order above).
PolygonMesh without_side(const PolygonMesh& molding, std::size_t side);

}  // namespace beambench::scenes::modelling

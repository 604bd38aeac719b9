#pragma once
// Walls with openings: of houses, of window frames, of doors with panels.

#include <span>

#include <glm/vec2.hpp>

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::modelling {

struct Rectangle {
  glm::dvec2 lower, upper;
};

/// The rectangle from (0, 0) to `size` in the plane z = 0, looking to +z, without the openings, and
/// the openings' sides down to z = -depth. The openings do not touch one another; one that reaches
/// the wall's edge has no side there.
PolygonMesh recessed(const glm::dvec2& size, std::span<const Rectangle> openings, double depth);

/// What closes the openings: a quad at z = -depth in each.
PolygonMesh openings_filled(std::span<const Rectangle> openings, double depth);

/// columns x rows equal openings in the rectangle, bars of the same width around all of them.
std::vector<Rectangle> panes(const glm::dvec2& size, int columns, int rows, double bar);

}  // namespace beambench::scenes::modelling

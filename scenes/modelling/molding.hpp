#pragma once
// Skirting boards, cornices, picture frames.

#include <array>
#include <span>

#include <glm/vec2.hpp>

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::modelling {

/// A profile of points (inset, z) carried round the rectangle from (0, 0) to `size`, with mitred
/// corners: four quads from each point to the next, along y = 0, x = size.x, y = size.y and x = 0
/// in that order. It looks up where the profile goes inward.
PolygonMesh molding(const glm::dvec2& size, std::span<const glm::dvec2> profile);

/// Without one of the rectangle's sides (0 ... 3, in the order above).
PolygonMesh without_side(const PolygonMesh& molding, std::size_t side);

}  // namespace beambench::scenes::modelling

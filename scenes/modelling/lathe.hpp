#pragma once
// A profile revolved about the z axis.

#include <span>

#include <glm/vec2.hpp>

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::modelling {

/// The profile's points (radius, height) revolved in `sides` steps, the first at `first_turn` of a
/// full turn. Walked upward on the outside, the surface looks outward. Each piece of the profile
/// gives a ring of flat quads, of triangles where one end has radius 0; a piece with both ends on
/// the axis gives none. Ends with a radius stay open.
PolygonMesh lathe(std::span<const glm::dvec2> profile, int sides, double first_turn = 0.0);

}  // namespace beambench::scenes::modelling

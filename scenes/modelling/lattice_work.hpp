#pragma once
// Lattices of bars, as iron towers and trellises are made of.

#include <span>

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::modelling {

/// A square bar of four sides between two places, two of its sides looking along `outward`. Its
/// ends are open: they are inside what it is fixed to.
PolygonMesh bar(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& outward,
                double thickness);

/// The bracing of a face between two posts, whose places are listed level by level from below: a
/// crossbar at every level and two diagonals in every panel. Crossing bars differ in thickness, so
/// that no two of them have a plane in common.
struct Bracing {
  double crossbar;
  double diagonal;
};
PolygonMesh braced_face(std::span<const glm::dvec3> left, std::span<const glm::dvec3> right,
                        const glm::dvec3& outward, const Bracing& bracing);

}  // namespace beambench::scenes::modelling

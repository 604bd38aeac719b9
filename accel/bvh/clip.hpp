#pragma once
// Computes the part of a primitive that lies in a box.

#include <optional>

#include "accel/bvh/primitive_part.hpp"
#include "accel/core/overlap.hpp"

namespace beambench::accel::bvh {

/// Returns the bounds of the part of a piece's surface that lies in the closed box `box`, or
/// nothing if no part does. Exact up to double rounding for triangles, which are clipped by the
/// box's planes (Sutherland and Hodgman, "Reentrant Polygon Clipping", 1974). Conservative for
/// spheres, treated as balls, and for cones, treated as their boxes.
std::optional<Box> clipped_bounds(const scenes::Scene& scene, const PrimitivePart& piece,
                                  const Box& box);

/// Returns the intersection of the box with the piece's whole box.
std::optional<Box> whole_bounds(const scenes::Scene& scene, const PrimitivePart& piece,
                                const Box& box);

}  // namespace beambench::accel::bvh

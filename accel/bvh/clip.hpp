#pragma once
// Which part of a primitive lies in a box.

#include <optional>

#include "accel/bvh/primitive_part.hpp"
#include "accel/core/overlap.hpp"

namespace beambench::accel::bvh {

/// The bounds, within `box`, of the part of a piece's surface that lies in a closed box; nothing
/// where no part does. Exact, to the rounding of double, for triangles, which are clipped by the
/// box's planes (Sutherland and Hodgman, "Reentrant Polygon Clipping", 1974). Conservative for
/// spheres, whose part is that of the ball, and for cones, whose part is that of their box.
std::optional<Box> clipped_bounds(const scenes::Scene& scene, const PrimitivePart& piece,
                                  const Box& box);

/// The same of the piece's whole box.
std::optional<Box> whole_bounds(const scenes::Scene& scene, const PrimitivePart& piece,
                                const Box& box);

}  // namespace beambench::accel::bvh

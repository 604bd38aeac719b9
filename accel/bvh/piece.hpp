#pragma once
// The pieces that leaves refer to in a hierarchy over separate triangles of polygons.

#include <cstdint>
#include <vector>

#include "scenes/scene.hpp"

namespace beambench::accel::bvh {

/// A triangle of a polygon, or a whole sphere or cone. The nearest hit of a polygon's triangles is
/// the polygon's hit.
struct Piece {
  scenes::PrimitiveId primitive;
  std::uint32_t index;  ///< into the scene's triangles, spheres or cones
};

/// Returns the pieces of all primitives, in increasing id.
std::vector<Piece> collect_pieces(const scenes::Scene& scene);

/// Returns the box of a piece, not widened.
scenes::Bounds piece_bounds(const scenes::Scene& scene, const Piece& piece);

}  // namespace beambench::accel::bvh

#pragma once
// What the leaves of a hierarchy refer to where the triangles of a polygon are separate.

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

/// The pieces of all primitives, in increasing id.
std::vector<Piece> collect_pieces(const scenes::Scene& scene);

/// The box of a piece, not widened.
scenes::Bounds piece_bounds(const scenes::Scene& scene, const Piece& piece);

}  // namespace beambench::accel::bvh

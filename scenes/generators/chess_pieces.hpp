#pragma once
// The pieces of `ajedrez`.

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench {

/// Staunton's pieces, standing at the origin of a board whose squares have side 1, without the
/// undersides they stand on. The knight looks to +y.
PolygonMesh chess_pawn();
PolygonMesh chess_rook();
PolygonMesh chess_knight();
PolygonMesh chess_bishop();
PolygonMesh chess_queen();
PolygonMesh chess_king();

}  // namespace beambench

#pragma once
// The pieces of `ajedrez`.

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::generators {

/// Staunton's pieces, standing at the origin of a board whose squares have side 1, without the
/// undersides they stand on. The knight looks to +y.
modelling::PolygonMesh chess_pawn();
modelling::PolygonMesh chess_rook();
modelling::PolygonMesh chess_knight();
modelling::PolygonMesh chess_bishop();
modelling::PolygonMesh chess_queen();
modelling::PolygonMesh chess_king();

}  // namespace beambench::scenes::generators

#pragma once
// Roofs of Spanish tiles.

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::generators {

/// A slope of the roof: from an eaves corner along the eaves and up to the ridge.
struct RoofSlope {
  glm::dvec3 corner;
  glm::dvec3 along;  ///< the eaves, with their length; along x up looks out of the roof
  glm::dvec3 up;     ///< to the ridge, with its length
  int tiles;         ///< along the eaves
  int rows;
};

/// Rows of round tiles, each row lying on the one below: six quads a tile.
modelling::PolygonMesh tiled_slope(const RoofSlope& slope);

/// The round tiles that cover a ridge.
modelling::PolygonMesh ridge_tiles(const glm::dvec3& from, const glm::dvec3& to, double radius,
                                   int tiles);

}  // namespace beambench::scenes::generators

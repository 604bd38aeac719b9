#pragma once
// The leaves of `maceta`.

#include <cstddef>

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::generators {

/// A long arching leaf: it rises from `root`, leans out and droops at its tip.
struct ArchingLeaf {
  glm::dvec3 root;
  double azimuth;  ///< the direction in which it leans, radians
  double rise;     ///< angle of its start above the horizontal, radians
  double fall;     ///< angle of its tip below the horizontal, radians
  double length;
  double width;
};

/// Returns the leaf as `pieces` pairs of quads left and right of its midrib, folded like a gutter:
/// 2 * pieces polygons. The last pair, at the tip, are triangles.
modelling::PolygonMesh arching_leaf(const ArchingLeaf& leaf, int pieces);

}  // namespace beambench::scenes::generators

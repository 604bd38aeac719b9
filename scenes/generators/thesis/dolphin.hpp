#pragma once
// The dolphin of `delfines`.

#include <cstddef>
#include <vector>

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::generators {

/// How a dolphin holds itself; radians over its length of 1.
struct DolphinPose {
  double arch = 0.0;  ///< back bent: head and tail down
  double turn = 0.0;  ///< head and tail to its left
};

/// A bottlenose dolphin, 1 long from beak (x = 0.5) to fluke (x = -0.5) before it bends, back to
/// +z, of `triangles` triangles: body, dorsal fin, two flippers, two flukes. `belly` tells which of
/// them are pale.
struct Dolphin {
  modelling::PolygonMesh mesh;
  std::vector<bool> belly;
};
Dolphin dolphin(const DolphinPose& pose, std::size_t triangles);

}  // namespace beambench::scenes::generators

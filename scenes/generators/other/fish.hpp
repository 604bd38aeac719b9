#pragma once
// The fish of `aquarium`.

#include <cstdint>
#include <vector>

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::generators {

/// A part of a fish with its own color.
enum class FishPart : std::uint8_t { kBody, kStripe, kFin, kEye };

/// A fish, 1 long from its nose (x = 0.5) to its tail (x = -0.5), with its back toward +z: a closed
/// body, and closed fins and eyes that grow out of it.
struct Fish {
  modelling::PolygonMesh mesh;  ///< triangles
  std::vector<FishPart> part;   ///< the part of each triangle
};

/// Returns a fish of 8 d^2 + 4 d + 112 triangles.
Fish fish(int detail);

}  // namespace beambench::scenes::generators

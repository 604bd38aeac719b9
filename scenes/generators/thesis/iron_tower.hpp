#pragma once
// The ironwork of `torre-eiffel`.

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::generators {

/// The four legs from the ground to the second floor, the shaft above and the arches between the
/// legs, in meters, the middle of its foot at the origin.
modelling::PolygonMesh iron_tower();

/// The three floors, without their galleries.
modelling::PolygonMesh tower_floors();

/// Posts and rails around the floors.
modelling::PolygonMesh tower_galleries();

/// The lantern above the third floor, and its mast up to 324 meters.
modelling::PolygonMesh tower_top();

/// The stone blocks under the posts of the legs.
modelling::PolygonMesh tower_foundations();

}  // namespace beambench::scenes::generators

#pragma once
// Adapts the hierarchy of tile beams to primitives that have moved.

#include "accel/tile_beam/tile_hierarchy.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::tile_beam {

/// Copies the coordinates of the scene to the blocks, and computes all boxes; the tree remains
/// (accel/bvh/refit.hpp). Requires that the hierarchy was built with `TileHierarchyOptions::moves`.
/// `parallel`: on all cores; the result is the same.
void refit(TileHierarchy& hierarchy, const scenes::Scene& scene, bool parallel);

}  // namespace beambench::accel::tile_beam

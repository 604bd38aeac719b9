#pragma once
// Refits the hierarchy of tile beams to primitives that have moved.

#include "accel/tile_beam/tile_hierarchy.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::tile_beam {

/// Copies the scene's coordinates to the blocks and computes all boxes; the tree remains
/// (accel/bvh/refit.hpp). The hierarchy must have been built with `TileHierarchyOptions::moves`.
/// `parallel`: use all cores; the result is the same.
void refit(TileHierarchy& hierarchy, const scenes::Scene& scene, bool parallel);

}  // namespace beambench::accel::tile_beam

#pragma once
// Improves a hierarchy that some builder has made.

#include "accel/bvh/bvh_builder.hpp"

namespace beambench::accel::bvh {

/// Takes nodes out and puts them back where they enlarge the boxes above them least (Bittner,
/// Hapala and Havran, "Fast insertion-based optimization of bounding volume hierarchies", 2013). In
/// each round the best places of the nodes with the largest boxes are found in the tree as it is,
/// independently of each other (Meister and Bittner, "Parallel reinsertion for bounding volume
/// hierarchy optimization", 2018). The nodes are then moved, those that gain most first, each only
/// if it still gains in the tree as it has become. Leaves and their boxes stay, so clipped boxes do
/// too. `sah_cost` does not grow, and no leaf is deeper than `kMaxBvhDepth`. `parallel`: on all
/// cores; the result is the same.
void reinsert(BinaryBvh& bvh, bool parallel);

}  // namespace beambench::accel::bvh

#pragma once
// Improves a hierarchy made by any builder.

#include "accel/bvh/bvh_builder.hpp"

namespace beambench::accel::bvh {

/// Removes nodes and reinserts them where they enlarge the boxes above them least (Bittner, Hapala
/// and Havran, "Fast insertion-based optimization of bounding volume hierarchies", 2013). Each
/// round finds the best places of the nodes with the largest boxes in the current tree,
/// independently of each other (Meister and Bittner, "Parallel reinsertion for bounding volume
/// hierarchy optimization", 2018). The nodes are then moved in order of decreasing gain, except
/// those that would no longer gain in the changed tree. Leaves and their boxes are kept, including
/// clipped boxes. `sah_cost` does not grow, and no leaf is deeper than `kMaxBvhDepth`. `parallel`:
/// use all cores; the result is the same.
void reinsert(BinaryBvh& bvh, bool parallel);

}  // namespace beambench::accel::bvh

#pragma once
// Lays out the nodes of a binary hierarchy that was built in another order.

#include <cstdint>
#include <span>

#include "accel/bvh/bvh_builder.hpp"

namespace beambench::accel::bvh {

/// Returns the hierarchy with the layout that all builders return: siblings together, each pair's
/// children after it, items in the order of leaves. In `nodes` the root must be first and siblings
/// together; the order is otherwise arbitrary, and nodes that cannot be reached from the root are
/// dropped. Subtrees at a depth of `kDeepestSahSplit` are rebuilt by splits in half, so that no
/// leaf is deeper than `kMaxBvhDepth`.
///
/// `next` may be empty. Otherwise the items of a leaf form a ring: `first` is the last one, and
/// `next[i]` follows item i.
BinaryBvh laid_out(std::span<const BvhNode> nodes, std::span<const std::uint32_t> items,
                   std::span<const std::uint32_t> next = {});

/// Merges sibling leaves, from the bottom up, where that does not raise the cost (`leaf_pays`).
void merge_leaves(BinaryBvh& bvh, const BvhOptions& options);

}  // namespace beambench::accel::bvh

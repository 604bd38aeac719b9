#pragma once
// Lays out the nodes of a binary hierarchy that was put together in another order.

#include <cstdint>
#include <span>

#include "accel/bvh/bvh_builder.hpp"

namespace beambench::accel::bvh {

/// Returns the hierarchy with the layout that all builders return: siblings together, each pair's
/// children behind it, items in the order of leaves. In `nodes` the root is first and siblings are
/// together, in any order, and nodes that are not reached from the root are left out. The leaves
/// of a subtree that begins at a depth of `kDeepestSahSplit` are divided anew, in the middle, so
/// that no leaf is deeper than `kMaxBvhDepth`.
///
/// `next` may be empty. Otherwise the items of a leaf are a ring: `first` is the last one, and
/// `next[i]` follows item i.
BinaryBvh laid_out(std::span<const BvhNode> nodes, std::span<const std::uint32_t> items,
                   std::span<const std::uint32_t> next = {});

/// Makes two sibling leaves one, from the bottom up, where that costs no more (`leaf_pays`).
void merge_leaves(BinaryBvh& bvh, const BvhOptions& options);

}  // namespace beambench::accel::bvh

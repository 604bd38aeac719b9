#pragma once
// Builds a binary hierarchy by the surface area heuristic, from boxes alone.

#include <cstdint>
#include <span>
#include <vector>

#include "scenes/bounds.hpp"

namespace beambench::accel::bvh {

/// The parameters of the cost that the builder minimizes.
struct BvhOptions {
  std::uint32_t max_leaf = 8;    ///< maximum number of items in a leaf
  std::uint32_t block_size = 8;  ///< items tested at once: a leaf of n costs ceil(n / block_size)
  float node_cost = 1.0F;        ///< cost of visiting a node, relative to testing a block
  bool parallel = false;         ///< use all cores; the result is the same
};

/// A node of a binary hierarchy: interior (its children are `first` and `first + 1`) or a leaf
/// (`count` items from `first` on).
struct BvhNode {
  scenes::Bounds box;
  std::uint32_t first;
  std::uint32_t count;  ///< 0 for an interior node

  bool is_leaf() const { return count > 0; }
};

struct BinaryBvh {
  std::vector<BvhNode> nodes;        ///< the root first, children after their parent; may be empty
  std::vector<std::uint32_t> items;  ///< indices, leaf by leaf; repeated only for divided items
  std::uint32_t depth = 0;           ///< nodes on the longest path to a leaf, including the leaf
};

/// The maximum number of nodes from the root to a leaf, whatever the boxes are.
inline constexpr std::uint32_t kMaxBvhDepth = 96;

/// Builds top-down, splitting at the best of up to 32 bins along each of the three axes (Wald, "On
/// fast construction of SAH-based bounding volume hierarchies", 2007). Boxes whose centers
/// coincide, and those below a depth that only contrived input reaches, are split in half.
BinaryBvh build_bvh(std::span<const scenes::Bounds> boxes, const BvhOptions& options);

/// Replaces each leaf by a hierarchy over its items, so that leaves may become smaller; the nodes
/// above the leaves are unchanged. A leaf stays undivided if its descendants would be deeper than
/// kMaxBvhDepth.
void divide_leaves(BinaryBvh& bvh, std::span<const scenes::Bounds> boxes,
                   const BvhOptions& options);

/// Returns the expected number of node visits and block tests for a ray that meets the root,
/// weighted by the options: the cost that the builder minimizes.
double sah_cost(const BinaryBvh& bvh, const BvhOptions& options);

/// Collects the nodes that become the children of `node` in a hierarchy of `width` children per
/// node: starting from its own two children, repeatedly replaces the interior node with the largest
/// area by its children while there is room. Writes to `children` (of size `width`) and returns
/// their number. `node` must be interior.
std::size_t gather_children(const BinaryBvh& bvh, std::uint32_t node,
                            std::span<std::uint32_t> children);

}  // namespace beambench::accel::bvh

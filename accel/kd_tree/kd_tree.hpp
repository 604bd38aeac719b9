#pragma once
// A kd-tree over a scene: binary space partitioning by planes perpendicular to the axes.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "accel/bvh/primitive_block.hpp"
#include "accel/core/expected_visits.hpp"
#include "accel/core/large_pages.hpp"
#include "accel/core/overlap.hpp"
#include "accel/core/statistics.hpp"
#include "accel/kd_tree/kd_tree_options.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::kd_tree {

/// A node in eight bytes (Wald, "Realtime Ray Tracing and Interactive Global Illumination",
/// dissertation, 2004): interior (its children are a pair of nodes, the one below the plane first)
/// or a leaf (a run of blocks). A plane is a float, so that building and traversal use the same
/// number.
class KdNode {
 public:
  static constexpr std::uint64_t kNodes = std::uint64_t{1} << 31U;  ///< maximum number of nodes

  KdNode() = default;
  static KdNode interior(std::size_t axis, float plane, std::uint32_t children) {
    return {static_cast<std::uint32_t>(axis) | children << 1U, std::bit_cast<std::uint32_t>(plane)};
  }
  static KdNode leaf(std::uint32_t first_block, std::uint32_t block_count) {
    return {kLeaf | block_count << 2U, first_block};
  }

  bool is_leaf() const { return (word_ & 3U) == kLeaf; }

  // For an interior node.
  std::size_t axis() const { return word_ & 3U; }
  float plane() const { return std::bit_cast<float>(other_); }
  std::uint32_t children() const {
    return (word_ & ~3U) >> 1U;
  }  ///< an even index, first of a pair

  // For a leaf.
  std::uint32_t first_block() const { return other_; }
  std::uint32_t block_count() const { return word_ >> 2U; }

 private:
  KdNode(std::uint32_t word, std::uint32_t other) : word_(word), other_(other) {}

  static constexpr std::uint32_t kLeaf = 3;
  std::uint32_t word_;   ///< axis or kLeaf; above it, half the children's index or the block count
  std::uint32_t other_;  ///< the plane, or the first block
};

/// A kd-tree over the triangles of polygons, spheres and cones. A leaf refers to each of these
/// whose surface overlaps the leaf's closed cell, widened by `overlap_tolerance`, in order of id
/// (kind by kind).
///
/// Nodes are in one array: the root, a gap, then pairs of siblings. All pairs below the lower of
/// two siblings come before those below the upper one.
struct KdTree {
  scenes::Bounds root;  ///< the root's cell, which contains all points where hits are possible
  scenes::Bounds scene_bounds;
  LargePageVector<KdNode> nodes;
  LargePageVector<bvh::PrimitiveBlock> blocks;
  std::uint64_t leaves = 0;
  std::uint64_t empty_leaves = 0;
  std::uint64_t references = 0;
  std::uint32_t depth = 0;  ///< nodes on the longest path to a leaf, including the leaf
  /// The cost defined by `bvh::sah_cost`: the expected number of interior nodes visited and blocks
  /// tested by a ray that meets the root.
  double cost = 0.0;
  ExpectedVisits visits;

  bool empty() const { return blocks.empty(); }
};

/// Throws an InputError that names `max_references` if the leaves have more references. Also throws
/// if there are more than KdNode::kNodes nodes or more pieces than an event can number.
KdTree build_kd_tree(const scenes::Scene& scene, const KdTreeOptions& options);

/// Return the children's cells: parts of `cell`, divided by the plane of an interior node.
scenes::Bounds lower_cell(const scenes::Bounds& cell, const KdNode& node);
scenes::Bounds upper_cell(const scenes::Bounds& cell, const KdNode& node);

/// The location of a node.
struct KdPlace {
  scenes::Bounds cell;
  int level;  ///< the root has level 1
};

/// Finds a node's location by descending from the root.
KdPlace place_of(const KdTree& tree, std::uint32_t node);

/// Calls `visit(leaf, place)` for all leaves, in the order of their nodes' pairs.
template <class Visit>
void for_each_leaf(const KdTree& tree, Visit visit) {
  struct Open {
    std::uint32_t node;
    KdPlace place;
  };
  std::vector<Open> open{{0, {tree.root, 1}}};
  while (!open.empty()) {
    const Open at = open.back();
    open.pop_back();
    const KdNode& node = tree.nodes[at.node];
    if (node.is_leaf()) {
      visit(node, at.place);
      continue;
    }
    const auto& [cell, level] = at.place;
    open.push_back({node.children() + 1, {upper_cell(cell, node), level + 1}});
    open.push_back({node.children(), {lower_cell(cell, node), level + 1}});
  }
}

}  // namespace beambench::accel::kd_tree

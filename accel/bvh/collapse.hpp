#pragma once
// Chooses which nodes of a binary hierarchy become the nodes and the leaves of a wide one.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "accel/bvh/bvh_builder.hpp"
#include "accel/bvh/primitive_block.hpp"

namespace beambench::accel::bvh {

/// The costs, for a stream of rays, of visiting a node and of visiting a leaf, by its number of
/// primitives.
struct CollapseCosts {
  float node = 1.0F;
  float leaf = 0.4F;
  float primitive = 0.12F;
  std::uint32_t max_leaf = 8;
};

/// Finds the wide hierarchy with the lowest expected cost by dynamic programming (Wald, Benthin and
/// Boulos, "Getting rid of packets", 2008, section 3.2; Ylitie, Karras and Laine, "Efficient
/// incoherent ray traversal on GPUs through compressed wide BVHs", 2017, section 3.1): the lowest
/// cost of a subtree as a forest of at most k roots is that of its two children with the k roots
/// divided between them. Items of a subtree must be contiguous, as in the hierarchies of our
/// builders.
class Collapse {
 public:
  Collapse(const BinaryBvh& bvh, const CollapseCosts& costs);

  /// Returns whether the subtree of a node becomes one leaf.
  bool is_leaf(std::uint32_t node) const { return plans_[node].is_leaf; }
  std::uint32_t first_item(std::uint32_t node) const { return plans_[node].first; }
  std::uint32_t item_count(std::uint32_t node) const { return plans_[node].count; }
  /// Writes the children of an interior node, and returns their number.
  std::size_t children_of(std::uint32_t node, std::array<std::uint32_t, kBvhLanes>& children) const;

 private:
  struct Plan {
    std::array<float, kBvhLanes> cost;          ///< lowest cost with at most i + 1 roots
    std::array<std::uint8_t, kBvhLanes> roots;  ///< how many are in the left child; 0: one root
    std::uint32_t first;                        ///< first item of the subtree
    std::uint32_t count;
    bool is_leaf;
  };

  void plan(std::uint32_t node, const CollapseCosts& costs);
  void gather(std::uint32_t node, std::size_t roots, std::array<std::uint32_t, kBvhLanes>& children,
              std::size_t& count) const;

  const BinaryBvh& bvh_;
  std::vector<Plan> plans_;
};

}  // namespace beambench::accel::bvh

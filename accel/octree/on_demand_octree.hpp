#pragma once
// An octree whose nodes are divided when the first ray enters them.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/cell.hpp"
#include "accel/core/cell_grid.hpp"
#include "accel/core/least_references.hpp"
#include "accel/core/overlap.hpp"
#include "accel/core/statistics.hpp"
#include "accel/octree/node_division.hpp"
#include "accel/octree/octree.hpp"
#include "scenes/primitive.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::octree {

struct Children;

/// A node, which is interior once it has children.
struct OnDemandNode {
  std::vector<scenes::PrimitiveId> references;
  mutable std::atomic<const Children*> children{nullptr};
};

/// The result of dividing a node.
struct Children {
  glm::ivec3 split;  ///< the planes between the children, as finest cells
  std::array<OnDemandNode, 8> nodes;
};

/// The octree of McNeill and others ("Performance of space subdivision techniques in ray tracing",
/// Computer Graphics Forum 11(4), 1992; thesis, section 2.2.2): few rays reach the small nodes, so
/// only the upper levels are divided in advance; lower nodes are divided when the first ray enters
/// them. The rules are the same (`NodeDivision`), so a ray passes through the same leaves as in
/// `Octree`.
///
/// Several threads may query at once. A thread that finds a node undivided divides it and then
/// publishes the children under a lock; a thread that comes second discards its own, identical
/// children. A divided node keeps its list, because another thread may still be dividing it.
class OnDemandOctree {
 public:
  /// Divides down to `built_level`. The scene must outlive this object. Throws an InputError that
  /// names `max_references` if the lists have more references.
  OnDemandOctree(const scenes::Scene& scene, const OctreeOptions& options);
  OnDemandOctree(const OnDemandOctree&) = delete;
  OnDemandOctree& operator=(const OnDemandOctree&) = delete;

  const CellGrid& grid() const { return division_.grid(); }
  const OnDemandNode& root() const { return root_; }
  OctreeCell root_cell() const { return division_.root(); }
  static std::span<const scenes::PrimitiveId> references(const OnDemandNode& leaf) {
    return leaf.references;
  }

  /// Returns the children of a node at a place, dividing the node if no ray has entered it before,
  /// or nullptr for a leaf. Throws an InputError that names `max_references` if the lists made so
  /// far have more references.
  const Children* children(const OnDemandNode& node, const OctreeCell& cell) const {
    const Children* children = node.children.load(std::memory_order_acquire);
    if (children != nullptr || !division_.divides(cell, node.references.size())) return children;
    return &divide(node, cell);
  }

  /// Returns statistics of the octree as divided so far. Nodes that may still be divided count as
  /// leaves and are also reported separately.
  Statistics statistics() const;
  /// Returns the current leaves that hold references.
  std::vector<Cell> occupied_cells() const;

 private:
  const Children& divide(const OnDemandNode& node, const OctreeCell& cell) const;
  void divide_to(const OnDemandNode& node, const OctreeCell& cell, int level) const;
  /// Calls `visit(node, cell, leaf)` for all current nodes, without dividing any.
  template <class Visit>
  void for_each_node(Visit visit) const;

  OctreeOptions options_;
  NodeDivision division_;
  OnDemandNode root_;
  // Mutable because queries add children, the same ones whatever their order.
  mutable std::mutex publishing_;
  mutable std::vector<std::unique_ptr<const Children>> divided_;
  mutable std::uint64_t references_made_ = 0;
  mutable ReferenceLimit limit_;
};

/// A node of an on-demand octree with its box. A node that must be divided is divided when the
/// cursor reaches it.
class OnDemandCursor {
 public:
  using Tree = OnDemandOctree;

  /// Starts at the root.
  explicit OnDemandCursor(const OnDemandOctree& octree)
      : octree_(&octree),
        node_(&octree.root()),
        cell_(octree.root_cell()),
        children_(octree.children(*node_, cell_)) {}

  const OnDemandNode& node() const { return *node_; }
  bool is_leaf() const { return children_ == nullptr; }
  /// Returns the code of the node: the child numbers on the path from the root, as octal digits
  /// after a 1. It does not depend on the order of division.
  std::uint64_t index() const { return code_; }
  const glm::ivec3& corner() const { return cell_.corner; }
  const glm::ivec3& size() const { return cell_.size; }
  int level() const { return cell_.level; }
  /// Returns the planes between the children, as finest cells. Must not be called for a leaf.
  glm::ivec3 split() const { return children_->split; }

  /// Descends to a child by its number (x + 2 y + 4 z). Must not be called for a leaf.
  void enter(std::uint32_t octant) {
    cell_ = cell_.child(children_->split, octant);
    node_ = &children_->nodes[octant];
    children_ = octree_->children(*node_, cell_);
    code_ = code_ * 8 + octant;
  }

 private:
  const OnDemandOctree* octree_;
  const OnDemandNode* node_;
  OctreeCell cell_;
  const Children* children_;  ///< nullptr for a leaf
  std::uint64_t code_ = 1;
};

}  // namespace beambench::accel::octree

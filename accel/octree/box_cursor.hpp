#pragma once
// A position in an octree with arbitrary planes.

#include <cstdint>

#include <glm/vec3.hpp>

#include "accel/octree/node_division.hpp"
#include "accel/octree/octree.hpp"

namespace beambench::accel::octree {

/// A node of an octree with its box. The cursor can only move down, because an adjacent node of
/// equal size may not exist.
class BoxCursor {
 public:
  using Tree = Octree;

  /// Starts at the root of an octree with arbitrary planes.
  explicit BoxCursor(const Octree& octree)
      : octree_(&octree), cell_{glm::ivec3(0), octree.grid().cells, 1} {}

  const OctreeNode& node() const { return octree_->nodes()[index_]; }
  bool is_leaf() const { return node().is_leaf(); }
  std::uint32_t index() const { return index_; }
  const glm::ivec3& corner() const { return cell_.corner; }
  const glm::ivec3& size() const { return cell_.size; }
  int level() const { return cell_.level; }
  /// Returns the planes between the children, as finest cells. Must not be called for a leaf.
  glm::ivec3 split() const { return octree_->split_of(node()); }

  /// Descends to a child by its number (x + 2 y + 4 z). Must not be called for a leaf.
  void enter(std::uint32_t octant) {
    cell_ = cell_.child(split(), octant);
    index_ = node().first + octant;
  }

 private:
  const Octree* octree_;
  std::uint32_t index_ = 0;
  OctreeCell cell_;
};

}  // namespace beambench::accel::octree

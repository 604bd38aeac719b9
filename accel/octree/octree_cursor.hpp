#pragma once
// A position in an octree: a node and its place.

#include <bit>
#include <cstdint>

#include <glm/vec3.hpp>

#include "accel/octree/octree.hpp"

namespace beambench::accel::octree {

/// A node of an octree with its integer position: the cube at `corner` with `size` finest cells per
/// axis.
class OctreeCursor {
 public:
  using Tree = Octree;

  /// Starts at the root.
  explicit OctreeCursor(const Octree& octree)
      : nodes_(octree.nodes().data()), size_(octree.grid().cells.x), cells_(size_) {}

  const OctreeNode& node() const { return nodes_[index_]; }
  bool is_leaf() const { return node().is_leaf(); }
  std::uint32_t index() const { return index_; }
  const glm::ivec3& corner() const { return corner_; }
  std::int32_t size() const { return size_; }
  /// Returns the level; the root has level 1.
  int level() const { return std::countr_zero(static_cast<std::uint32_t>(cells_ / size_)) + 1; }

  /// Returns the planes between the children, as finest cells. Must not be called for a leaf.
  glm::ivec3 split() const { return corner_ + size_ / 2; }

  /// Descends to a child by its number (x + 2 y + 4 z). Must not be called for a leaf.
  void enter(std::uint32_t octant) {
    index_ = node().first + octant;
    size_ /= 2;
    for (int axis = 0; axis < 3; ++axis) {
      if ((octant >> static_cast<unsigned>(axis) & 1U) != 0) corner_[axis] += size_;
    }
  }

  /// Descends to the child whose lowest finest cell is `corner`. Must not be called for a leaf.
  void enter_child(const glm::ivec3& corner) {
    size_ /= 2;
    std::uint32_t octant = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if ((corner[axis] & size_) != 0) octant |= 1U << static_cast<unsigned>(axis);
    }
    index_ = node().first + octant;
    corner_ = corner;
  }

  /// Moves to the neighbor of equal or larger size across the faces of one or more axes (a face,
  /// edge or vertex neighbor) by Samet's search: climbs to the nearest common ancestor and descends
  /// along the mirrored path as far as there are nodes (Samet, "Implementing ray tracing with
  /// octrees and neighbor finding", Computers & Graphics 13(4), 1989; thesis, section 3.5.2.2).
  /// `step` holds -1, 0 or 1 for each axis. Returns the number of levels climbed and descended, or
  /// 0 if the neighbor would lie outside the root.
  [[gnu::always_inline]] int move_to_neighbor(const glm::ivec3& step) {
    const glm::ivec3 target = corner_ + step * size_;
    std::uint32_t differing = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (target[axis] < 0 || target[axis] >= cells_) return 0;
      differing |= static_cast<std::uint32_t>(target[axis] ^ corner_[axis]);
    }
    const std::int32_t equal_size = size_;
    int levels = 0;
    // Climb: the common ancestor spans the highest bit in which the coordinates differ.
    const auto ancestor_size = static_cast<std::int32_t>(std::bit_floor(differing)) * 2;
    for (; size_ < ancestor_size; ++levels) {
      index_ = node().parent;
      size_ *= 2;
    }
    // Descend along the mirrored path: the bits of the target's coordinates describe the path with
    // the crossed axes reflected.
    for (; size_ > equal_size && !node().is_leaf(); ++levels) {
      size_ /= 2;
      std::uint32_t octant = 0;
      for (int axis = 0; axis < 3; ++axis) {
        if ((target[axis] & size_) != 0) octant |= 1U << static_cast<unsigned>(axis);
      }
      index_ = node().first + octant;
    }
    for (int axis = 0; axis < 3; ++axis) corner_[axis] = target[axis] & -size_;
    return levels;
  }

  /// Jumps to a node whose position is known.
  void jump(std::uint32_t index, const glm::ivec3& corner, std::int32_t size) {
    index_ = index;
    corner_ = corner;
    size_ = size;
  }

 private:
  std::uint32_t index_ = 0;
  const OctreeNode* nodes_;
  glm::ivec3 corner_{0};
  std::int32_t size_;
  std::int32_t cells_;
};

/// Returns a cursor at the node of `size` at `corner`, which must be in the octree.
inline OctreeCursor cursor_of(const Octree& octree, const glm::ivec3& corner, std::int32_t size) {
  OctreeCursor cursor(octree);
  while (cursor.size() > size) cursor.enter_child(corner & glm::ivec3(-(cursor.size() / 2)));
  return cursor;
}

}  // namespace beambench::accel::octree

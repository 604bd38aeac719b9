#pragma once
// Finds the next leaf along a ray by a search from the root.

#include <glm/vec3.hpp>

#include "accel/core/statistics.hpp"

namespace beambench::accel::octree {

/// Implements the interface of `LeafWalk` by searching for the next leaf from the root each time
/// (Glassner, "Space subdivision for fast ray tracing", IEEE CG&A 4(10), 1984; the "root" methods
/// of the thesis, section 2.2.2). Nodes need neither parents nor neighbors of the same size, so
/// planes may be arbitrary.
///
/// Glassner moves a point slightly beyond the leaf and locates it. Here no point is moved: the
/// search uses the planes that the ray has crossed at the leaf's exit, so that no thin leaf is
/// skipped. Glassner finds nodes by a hash of their names, as `HashedOctree` does, but the nodes on
/// the path are the same.
template <class CursorType>
class RootSearch {
 public:
  using Cursor = CursorType;
  static constexpr bool kNeighborSteps = false;

  explicit RootSearch(const typename Cursor::Tree& octree) : octree_(&octree) {}
  // The octree is a member of the same structure, which is not moved.
  RootSearch(const RootSearch&) = delete;
  RootSearch& operator=(const RootSearch&) = delete;

  int move(Cursor& cursor, const glm::ivec3& step) const {
    const glm::ivec3& cells = octree_->grid().cells;
    const glm::ivec3 end = cursor.corner() + cursor.size();
    for (int axis = 0; axis < 3; ++axis) {
      if (step[axis] < 0 && cursor.corner()[axis] == 0) return 0;
      if (step[axis] > 0 && end[axis] == cells[axis]) return 0;
    }
    cursor = Cursor(*octree_);
    return 1;
  }
  static void describe(Statistics&) {}
  template <class Counting>
  static void count_last_climb(int, Counting&) {}

 private:
  const typename Cursor::Tree* octree_;
};

}  // namespace beambench::accel::octree

#pragma once
// Samet's neighbors: found over the nearest common ancestor.

#include "accel/octree/octree_cursor.hpp"
#include "accel/octree/octree_tracer.hpp"

namespace beambench::accel::octree {

/// Neighbors as Samet finds them: nothing is stored, each move climbs and descends.
class AncestorNeighbors {
 public:
  explicit AncestorNeighbors(const Octree&) {}

  [[gnu::always_inline]] static int move(OctreeCursor& cursor, const glm::ivec3& step) {
    return cursor.move_to_neighbor(step);
  }
  static void describe(Statistics&) {}
};

/// Samet's traversal of the octree (Computers & Graphics 13(4), 1989).
using Samet = OctreeTracer<AncestorNeighbors>;

}  // namespace beambench::accel::octree

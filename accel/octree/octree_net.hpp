#pragma once
// The net over an octree: links from each face of a node to the node behind it.

#include <array>
#include <cstdint>
#include <vector>

#include "accel/octree/octree.hpp"
#include "accel/octree/octree_cursor.hpp"

namespace beambench::accel::octree {

/// Links each node, through each of its six faces, to the neighbor of equal or larger size. A link
/// replaces Samet's search via the common ancestor by one step to the same node. If the neighbors
/// are smaller, the link leads to their ancestor of equal size, from which the ray descends.
///
/// Only faces are linked. Neighbors across an edge or a vertex, which few rays meet exactly, are
/// found by Samet's search.
class OctreeNet {
 public:
  using Cursor = OctreeCursor;
  static constexpr bool kNeighborSteps = true;

  /// Links all nodes in one pass: a child's links follow from its parent's.
  explicit OctreeNet(const Octree& octree);

  /// Implements the interface of `LeafWalk`.
  int move(OctreeCursor& cursor, const glm::ivec3& step) const {
    const int face = face_of(step);
    if (face == kNoFace) return cursor.move_to_neighbor(step);
    const std::uint32_t next = places_[cursor.index()].neighbors[static_cast<std::size_t>(face)];
    if (next == kOutside) return 0;
    const Place& place = places_[next];
    cursor.jump(next, {place.corner[0], place.corner[1], place.corner[2]}, place.size);
    return 1;
  }

  /// Returns the node behind a face, `2 * axis` (below) or `2 * axis + 1` (above), or kOutside
  /// behind a face of the root.
  std::uint32_t neighbor(std::uint32_t node, int face) const {
    return places_[node].neighbors[static_cast<std::size_t>(face)];
  }
  static constexpr std::uint32_t kOutside = 0xFFFFFFFFU;

  template <class Counting>
  static void count_last_climb(int, Counting&) {}
  /// Adds the memory of the links to the statistics.
  void describe(Statistics& statistics) const;

 private:
  /// The data of a node needed for a step, in half a cache line.
  struct Place {
    std::array<std::uint32_t, 6> neighbors;
    std::array<std::uint16_t, 3> corner;  ///< coordinates in finest cells
    std::uint16_t size;
  };

  static constexpr int kNoFace = -1;
  /// Returns the face that a step along one axis crosses, or kNoFace for a step along several axes.
  static int face_of(const glm::ivec3& step) {
    switch (step.x + 3 * step.y + 9 * step.z) {
      case -1:
        return 0;
      case 1:
        return 1;
      case -3:
        return 2;
      case 3:
        return 3;
      case -9:
        return 4;
      case 9:
        return 5;
      default:
        return kNoFace;
    }
  }

  std::vector<Place> places_;  ///< one for each node
};

}  // namespace beambench::accel::octree

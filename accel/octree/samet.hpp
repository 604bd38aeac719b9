#pragma once
// Samet's traversal of the thesis's octree, with neighbors searched or linked beforehand.

#include <cstdint>
#include <string_view>

#include <glm/vec3.hpp>

#include "accel/core/statistics.hpp"
#include "accel/octree/leaf_walk.hpp"
#include "accel/octree/octree.hpp"
#include "accel/octree/octree_cursor.hpp"
#include "accel/octree/octree_net.hpp"
#include "accel/octree/octree_tracer.hpp"

namespace beambench::accel::octree {

/// A counter of structures with Samet's search (`kLastClimbMeaning`).
inline constexpr std::string_view kLastClimb = "last_climb";
inline constexpr std::string_view kLastClimbMeaning =
    "levels between the root and the leaf from which a ray leaves the octree: Samet's search "
    "climbs them before it finds that the leaf has no neighbor; here they are not climbed and are "
    "not traversal steps";

/// Samet's search via the nearest common ancestor: no links are stored; each move climbs and
/// descends.
class AncestorNeighbors {
 public:
  using Cursor = OctreeCursor;
  static constexpr bool kNeighborSteps = true;

  explicit AncestorNeighbors(const Octree&) {}

  [[gnu::always_inline]] static int move(OctreeCursor& cursor, const glm::ivec3& step) {
    return cursor.move_to_neighbor(step);
  }
  static void describe(Statistics&) {}

  /// Counts a ray that left the root from a leaf of this level. A search that only follows pointers
  /// would first climb to the root; the cursor's coordinates save these steps.
  template <class Counting>
  static void count_last_climb(int level, Counting& counting) {
    counting.add(kLastClimb, static_cast<std::uint64_t>(level - 1));
  }
};

/// Samet's traversal of the octree (Computers & Graphics 13(4), 1989).
using Samet = OctreeTracer<AncestorNeighbors>;

/// Samet's traversal with the neighbors linked beforehand (Endl and Sommer, "Classification of
/// ray-generators in uniform subdivisions and octrees for ray tracing", Computer Graphics Forum
/// 13(1), 1994; thesis, section 5.4.1).
using SametNet = OctreeTracer<OctreeNet>;

}  // namespace beambench::accel::octree

#pragma once
// The leaves of an octree along a ray, in order.

#include <algorithm>
#include <array>
#include <string_view>

#include "accel/core/cell_ray.hpp"
#include "accel/core/trace_step.hpp"
#include "accel/core/work_counters.hpp"
#include "accel/octree/octree.hpp"
#include "accel/octree/octree_cursor.hpp"

namespace beambench::accel::octree {

/// A counter of structures over an octree: nodes passed from a leaf to its neighbor of equal or
/// larger size. The descent to a smaller leaf, the same for all, is not counted.
inline constexpr std::string_view kNeighborSteps = "neighbor_steps";
inline constexpr std::string_view kNeighborStepsMeaning =
    "nodes of the octree passed from a leaf to its neighbor of equal or larger size; the descent "
    "to a smaller leaf is not counted";

/// Where a ray leaves a leaf: at t, over the face, edge or vertex that `step` (-1, 0 or 1 for each
/// axis) points at.
struct LeafExit {
  double t;
  glm::ivec3 step;
};
[[gnu::always_inline]] inline LeafExit leaf_exit(const CellRay& ray, const OctreeCursor& cursor) {
  const std::array<double, 3> exits{ray.exit_t(0, cursor.corner(), cursor.size()),
                                    ray.exit_t(1, cursor.corner(), cursor.size()),
                                    ray.exit_t(2, cursor.corner(), cursor.size())};
  LeafExit exit{std::min({exits[0], exits[1], exits[2]}), glm::ivec3(0)};
  for (int axis = 0; axis < 3; ++axis) {
    if (exits[static_cast<std::size_t>(axis)] == exit.t) exit.step[axis] = ray.step(axis);
  }
  return exit;
}

/// The leaves that a ray passes through, in order (Samet, "Implementing ray tracing with octrees
/// and neighbor finding", Computers & Graphics 13(4), 1989; thesis, sections 2.2.2 and 5.4.1): the
/// exit point of a leaf is computed, and the leaf behind it is found. A ray that leaves through an
/// edge or a vertex goes to the edge or vertex neighbor.
///
/// `neighbors.move(cursor, step)` moves the cursor from a leaf to the node of equal or larger size
/// behind the face, edge or vertex that `step` (-1, 0 or 1 for each axis) points at, and returns
/// the number of nodes passed, the last one included; 0 where the root ends.
template <class Neighbors>
struct LeafWalk {
  const Octree& octree;
  const Neighbors& neighbors;
  const Ray& ray;
  const CellRay& planes;  ///< of `ray` and the octree's grid

  /// Calls `visit(leaf, exit_t)` for the leaves from a node on that the ray enters at t, until it
  /// returns true or the ray leaves the root. `passed` nodes were passed to find that node, itself
  /// included.
  template <class Counting, class Visit>
  [[gnu::always_inline]] void from(OctreeCursor cursor, double t, int passed, Counting& counting,
                                   Visit visit) const {
    while (true) {
      passed += cursor.descend(planes, t);
      const OctreeNode& leaf = cursor.node();
      counting.add(Counter::kTraversalSteps, static_cast<std::uint64_t>(passed));
      counting.add(Counter::kLeaves);
      counting.add(Counter::kEmptyLeaves, leaf.count == 0 ? 1 : 0);

      const LeafExit exit = leaf_exit(planes, cursor);
      counting.enter([&] {
        return TraceStep{.place = "leaf",
                         .index = cursor.index(),
                         .level = cursor.level(),
                         .box = octree.grid().box(cursor.corner(), cursor.size()),
                         .t_enter = std::max(t, static_cast<double>(ray.t_min)),
                         .t_exit = exit.t};
      });
      if (visit(leaf, exit.t)) return;
      t = exit.t;
      passed = neighbors.move(cursor, exit.step);
      if (passed == 0) return;
      counting.add(kNeighborSteps, static_cast<std::uint64_t>(passed));
    }
  }

  /// The leaves behind a leaf.
  template <class Counting, class Visit>
  [[gnu::always_inline]] void behind(OctreeCursor leaf, Counting& counting, Visit visit) const {
    const LeafExit exit = leaf_exit(planes, leaf);
    const int passed = neighbors.move(leaf, exit.step);
    if (passed == 0) return;
    counting.add(kNeighborSteps, static_cast<std::uint64_t>(passed));
    from(leaf, exit.t, passed, counting, visit);
  }
};

/// Calls `visit(leaf, exit_t)` for the leaves that the ray passes through, from t_min on, until it
/// returns true or the ray leaves the root.
template <class Neighbors, class Counting, class Visit>
void walk_leaves(const Octree& octree, const Neighbors& neighbors, const Ray& ray,
                 Counting& counting, Visit visit) {
  const CellRay planes(octree.grid(), ray);
  const double t = planes.enter(ray.t_min);
  if (!(t < kInfinity)) return;
  LeafWalk<Neighbors>{octree, neighbors, ray, planes}.from(OctreeCursor(octree), t, 1, counting,
                                                           visit);
}

}  // namespace beambench::accel::octree

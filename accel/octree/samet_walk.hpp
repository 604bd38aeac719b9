#pragma once
// The leaves of an octree along a ray, in order.

#include <algorithm>
#include <array>

#include "accel/octree/octree.hpp"
#include "accel/octree/octree_cursor.hpp"
#include "accel/octree/octree_ray.hpp"
#include "accel/trace_step.hpp"
#include "accel/work_counters.hpp"

namespace beambench {

/// Calls `visit(leaf, exit_t)` for the leaves that the ray passes through, from t_min on, until it
/// returns true or the ray leaves the root (Samet, "Implementing ray tracing with octrees and
/// neighbor finding", Computers & Graphics 13(4), 1989; thesis, sections 2.2.2 and 5.4.1): the exit
/// point of a leaf is computed, and the neighbour behind it is found over the nearest common
/// ancestor. A ray that leaves through an edge or a vertex goes to the edge or vertex neighbour.
template <class Counting, class Visit>
void walk_leaves(const Octree& octree, const Ray& ray, Counting& counting, Visit visit) {
  const OctreeRay way(octree.grid(), ray);
  double t = way.enter_root(ray.t_min);
  if (!(t < kInfinity)) return;
  OctreeCursor cursor(octree);
  int levels = 1;  // the root
  while (true) {
    levels += cursor.descend(way, t);
    const OctreeNode& leaf = cursor.node();
    counting.add(Counter::kTraversalSteps, static_cast<std::uint64_t>(levels));
    counting.add(Counter::kLeaves);
    counting.add(Counter::kEmptyLeaves, leaf.count == 0 ? 1 : 0);

    const std::array<double, 3> exits{way.exit_t(0, cursor.corner(), cursor.size()),
                                      way.exit_t(1, cursor.corner(), cursor.size()),
                                      way.exit_t(2, cursor.corner(), cursor.size())};
    const double enter_t = t;
    t = std::min({exits[0], exits[1], exits[2]});
    counting.enter([&] {
      return TraceStep{.place = "leaf",
                       .index = cursor.index(),
                       .level = cursor.level(),
                       .box = octree.grid().box(cursor.corner(), cursor.size()),
                       .t_enter = std::max(enter_t, static_cast<double>(ray.t_min)),
                       .t_exit = t};
    });
    if (visit(leaf, t)) return;
    glm::ivec3 step(0);
    for (int axis = 0; axis < 3; ++axis) {
      if (exits[static_cast<std::size_t>(axis)] == t) step[axis] = way.step(axis);
    }
    levels = 0;
    if (!cursor.move_to_neighbour(step, levels)) return;
  }
}

}  // namespace beambench

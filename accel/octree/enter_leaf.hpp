#pragma once
// A ray in a leaf of an octree: finds its exit and counts its visit.

#include <algorithm>
#include <array>
#include <cstddef>

#include <glm/vec3.hpp>

#include "accel/core/cell_ray.hpp"
#include "accel/core/ray.hpp"
#include "accel/core/trace_step.hpp"
#include "accel/core/work_counters.hpp"

namespace beambench::accel::octree {

/// The exit of a ray from a leaf: at t, through the face, edge or vertex that `step` (-1, 0 or 1
/// for each axis) points at.
struct LeafExit {
  double t;
  glm::ivec3 step;
};
template <class Cursor>
[[gnu::always_inline]] inline LeafExit leaf_exit(const CellRay& ray, const Cursor& cursor) {
  const std::array<double, 3> exits{ray.exit_t(0, cursor.corner(), cursor.size()),
                                    ray.exit_t(1, cursor.corner(), cursor.size()),
                                    ray.exit_t(2, cursor.corner(), cursor.size())};
  LeafExit exit{std::min({exits[0], exits[1], exits[2]}), glm::ivec3(0)};
  for (int axis = 0; axis < 3; ++axis) {
    if (exits[static_cast<std::size_t>(axis)] == exit.t) exit.step[axis] = ray.step(axis);
  }
  return exit;
}

/// Counts and records that the ray is in the cursor's leaf from t to `exit_t`. Steps are not
/// counted here, because traversals take different numbers of steps to find the leaf.
template <class Cursor, class Counting>
[[gnu::always_inline]] inline void enter_leaf(const Cursor& cursor, const Ray& ray, double t,
                                              double exit_t, const typename Cursor::Tree& octree,
                                              Counting& counting) {
  counting.add(Counter::kLeaves);
  counting.add(Counter::kEmptyLeaves, octree.references(cursor.node()).empty() ? 1 : 0);
  counting.enter([&] {
    return TraceStep{.place = "leaf",
                     .index = cursor.index(),
                     .level = cursor.level(),
                     .box = octree.grid().box(cursor.corner(), cursor.size()),
                     .t_enter = std::max(t, static_cast<double>(ray.t_min)),
                     .t_exit = exit_t};
  });
}

}  // namespace beambench::accel::octree

#pragma once
// Finds the leaves that a ray crosses by descending from the octree's root, visiting children in
// the order in which the ray enters them.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/vec3.hpp>

#include "accel/core/cell_ray.hpp"
#include "accel/core/ray.hpp"
#include "accel/core/statistics.hpp"
#include "accel/core/work_counters.hpp"
#include "accel/octree/enter_leaf.hpp"

namespace beambench::accel::octree {

/// Gargantini and Atkinson, "Ray tracing an octree: numerical evaluation of the first
/// intersection", Computer Graphics Forum 12(4), 1993: the ordered parameters of the ray at the
/// three planes between a node's children determine the children that it passes through (at most
/// four), and the interval in each. A node is visited once per ray; neighbors of leaves are not
/// searched for.
///
/// Gargantini and Atkinson use a linear octree, which stores the codes of occupied leaves; among
/// our octrees, `HashedOctree` comes closest.
template <class CursorType>
class ParametricSearch {
 public:
  using Cursor = CursorType;

  explicit ParametricSearch(const typename Cursor::Tree&) {}
  static void describe(Statistics&) {}
};

/// One ray's path through an octree with `ParametricSearch`. `visit(leaf, exit_t)` returns true to
/// stop after that leaf.
template <class Cursor, class Counting, class Visit>
class ParametricWalk {
 public:
  ParametricWalk(const typename Cursor::Tree& octree, const Ray& ray, const CellRay& planes,
                 Counting& counting, Visit& visit)
      : octree_(octree), ray_(ray), planes_(planes), counting_(counting), visit_(visit) {}

  /// Visits the leaves below a node that the ray passes through between t and `exit_t`. Returns
  /// whether `visit` returned true.
  bool through(const Cursor& node, double t, double exit_t) const {
    counting_.add(Counter::kTraversalSteps);
    if (node.is_leaf()) {
      enter_leaf(node, ray_, t, exit_t, octree_, counting_);
      return visit_(node.node(), exit_t);
    }
    const glm::ivec3 split = node.split();
    std::array<double, 3> crossings{};
    std::uint32_t octant = 0;
    for (int axis = 0; axis < 3; ++axis) {
      // A plane that the ray is parallel to is not crossed.
      crossings[static_cast<std::size_t>(axis)] =
          planes_.step(axis) == 0 ? kInfinity : planes_.plane_t(axis, split[axis]);
      if (planes_.above(axis, split[axis], t)) octant |= bit(axis);
    }
    while (true) {
      // The planes already crossed are at or before t.
      double next = exit_t;
      for (const double crossing : crossings) {
        if (crossing > t) next = std::min(next, crossing);
      }
      Cursor child = node;
      child.enter(octant);
      if (through(child, t, next)) return true;
      // A plane crossed where the ray leaves the node does not lead to another child.
      if (!(next < exit_t)) return false;
      t = next;
      for (int axis = 0; axis < 3; ++axis) {
        // Through an edge or a vertex, the ray continues into the opposite child.
        if (crossings[static_cast<std::size_t>(axis)] == t) octant ^= bit(axis);
      }
    }
  }

 private:
  static constexpr std::uint32_t bit(int axis) { return 1U << static_cast<unsigned>(axis); }

  const typename Cursor::Tree& octree_;
  const Ray& ray_;
  const CellRay& planes_;
  Counting& counting_;
  Visit& visit_;
};

/// Calls `visit(leaf, exit_t)` for the leaves that the ray passes through, from t_min on, until
/// `visit` returns true or the ray leaves the root. The leaves, their order and their exits are the
/// same as in every other search.
template <class Cursor, class Counting, class Visit>
void walk_leaves(const typename Cursor::Tree& octree, const ParametricSearch<Cursor>&,
                 const Ray& ray, Counting& counting, Visit visit) {
  const CellRay planes(octree.grid(), ray);
  const double t = planes.enter(ray.t_min);
  if (!(t < kInfinity)) return;
  const Cursor root(octree);
  ParametricWalk<Cursor, Counting, Visit>(octree, ray, planes, counting, visit)
      .through(root, t, leaf_exit(planes, root).t);
}

}  // namespace beambench::accel::octree

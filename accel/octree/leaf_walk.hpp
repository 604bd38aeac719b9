#pragma once
// The leaves of an octree along a ray, in order.

#include <cstdint>
#include <string_view>

#include "accel/core/cell_ray.hpp"
#include "accel/core/work_counters.hpp"
#include "accel/octree/descend.hpp"
#include "accel/octree/enter_leaf.hpp"

namespace beambench::accel::octree {

/// A counter of structures over an octree: nodes passed from a leaf to its neighbor of equal or
/// larger size. The descent to a smaller leaf is the same for all structures and is not counted.
inline constexpr std::string_view kNeighborSteps = "neighbor_steps";
inline constexpr std::string_view kNeighborStepsMeaning =
    "nodes of the octree passed from a leaf to its neighbor of equal or larger size; the descent "
    "to a smaller leaf is not counted";

/// The leaves that a ray passes through, in order (Samet, "Implementing ray tracing with octrees
/// and neighbor finding", Computers & Graphics 13(4), 1989; thesis, sections 2.2.2 and 5.4.1): the
/// exit point of a leaf is computed, and the leaf behind it is found. A ray that leaves through an
/// edge or a vertex continues in the edge or vertex neighbor.
///
/// `search.move(cursor, step)` moves the cursor from a leaf to a node behind the face, edge or
/// vertex that `step` (-1, 0 or 1 for each axis) points at; the search for the next leaf descends
/// from this node. It returns the number of nodes passed, including the last one, or 0 if the ray
/// leaves the root. `Search::Cursor` is a place in the octree; `Search::kNeighborSteps` states
/// whether the node reached is the neighbor of equal or larger size, in which case the passed nodes
/// are neighbor steps. `Search::count_last_climb(level, counting)` counts the search's extra work
/// when a ray leaves the root from a leaf of that level.
template <class Search>
struct LeafWalk {
  using Cursor = typename Search::Cursor;

  const typename Cursor::Tree& octree;
  const Search& search;
  const Ray& ray;
  const CellRay& planes;  ///< `ray` in the octree's grid

  /// Calls `visit(leaf, exit_t)` for the leaves along the ray, starting from a node that the ray
  /// enters at t, until `visit` returns true or the ray leaves the root. `passed` is the number of
  /// nodes passed to find that node, including the node itself. Returns the level of the leaf in
  /// which the ray left the root, or 0 if it did not leave.
  template <class Counting, class Visit>
  [[gnu::always_inline]] int from(Cursor cursor, double t, int passed, Counting& counting,
                                  Visit visit) const {
    while (true) {
      passed += descend_to_leaf(cursor, planes, t);
      counting.add(Counter::kTraversalSteps, static_cast<std::uint64_t>(passed));
      const LeafExit exit = leaf_exit(planes, cursor);
      enter_leaf(cursor, ray, t, exit.t, octree, counting);
      if (visit(cursor.node(), exit.t)) return 0;
      t = exit.t;
      passed = search.move(cursor, exit.step);
      if (passed == 0) return cursor.level();
      if constexpr (Search::kNeighborSteps) {
        counting.add(kNeighborSteps, static_cast<std::uint64_t>(passed));
      }
    }
  }

  /// Visits the leaves behind a leaf.
  template <class Counting, class Visit>
  [[gnu::always_inline]] void behind(Cursor leaf, Counting& counting, Visit visit) const {
    const LeafExit exit = leaf_exit(planes, leaf);
    const int passed = search.move(leaf, exit.step);
    if (passed == 0) return;
    if constexpr (Search::kNeighborSteps) {
      counting.add(kNeighborSteps, static_cast<std::uint64_t>(passed));
    }
    from(leaf, exit.t, passed, counting, visit);
  }
};

// Clang before version 17 does not deduce the arguments of aggregates.
template <class Search>
LeafWalk(const typename Search::Cursor::Tree&, const Search&, const Ray&, const CellRay&)
    -> LeafWalk<Search>;

/// Calls `visit(leaf, exit_t)` for the leaves that the ray passes through, from t_min on, until
/// `visit` returns true or the ray leaves the root.
template <class Search, class Counting, class Visit>
void walk_leaves(const typename Search::Cursor::Tree& octree, const Search& search, const Ray& ray,
                 Counting& counting, Visit visit) {
  const CellRay planes(octree.grid(), ray);
  const double t = planes.enter(ray.t_min);
  if (!(t < kInfinity)) return;
  const int left = LeafWalk<Search>{octree, search, ray, planes}.from(
      typename Search::Cursor(octree), t, 1, counting, visit);
  if (left > 0) Search::count_last_climb(left, counting);
}

}  // namespace beambench::accel::octree

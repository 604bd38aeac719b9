#pragma once
// Finds the leaves of an octree along a ray by iteration over its finest cells.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string_view>

#include <glm/vec3.hpp>
#include <glm/vector_relational.hpp>

#include "accel/core/cell_ray.hpp"
#include "accel/core/ray.hpp"
#include "accel/core/statistics.hpp"
#include "accel/core/work_counters.hpp"
#include "accel/octree/enter_leaf.hpp"

namespace beambench::accel::octree {

/// A counter of planes between finest cells that rays cross.
inline constexpr std::string_view kPlaneSteps = "plane_steps";
inline constexpr std::string_view kPlaneStepsMeaning =
    "planes between the octree's finest cells that rays cross, with exits=iterative";

/// The iterative methods of the thesis (section 2.2.2): the exit of a leaf is not computed from its
/// planes; the ray steps from one finest cell to the next, as in a grid, until it is no longer in
/// the leaf (Fujimoto, Tanaka and Iwata, "ARTS: Accelerated ray-tracing system", IEEE CG&A 6(4),
/// 1986; Sung, "A DDA octree traversal algorithm for ray tracing", Eurographics 1991, steps by
/// larger cells where it can). The leaf of the cell is then found by a search from the root. A
/// large leaf costs as many steps as it has cells along the ray.
///
/// The original methods add up the differences in t between planes. Here each plane's t is
/// computed, so that leaves and exits equal those of the other searches. If two planes round to the
/// same position, there may be more leaves of length 0.
template <class CursorType>
class IterativeSearch {
 public:
  using Cursor = CursorType;

  explicit IterativeSearch(const typename Cursor::Tree&) {}
  static void describe(Statistics&) {}
};

/// The finest cell that a ray is in.
class CellSteps {
 public:
  CellSteps(const CellRay& ray, double t) : ray_(&ray) {
    for (int axis = 0; axis < 3; ++axis) cell_[axis] = ray.cell_at(axis, t);
  }

  const glm::ivec3& cell() const { return cell_; }
  bool is_in(const glm::ivec3& corner, const glm::ivec3& end) const {
    return glm::all(glm::greaterThanEqual(cell_, corner)) && glm::all(glm::lessThan(cell_, end));
  }
  /// Moves to the next cell, through an edge or a vertex if several planes are crossed together.
  /// Returns the t of the planes.
  double step() {
    glm::dvec3 crossings(std::numeric_limits<double>::infinity());
    for (int axis = 0; axis < 3; ++axis) {
      if (ray_->step(axis) == 0) continue;
      crossings[axis] = ray_->plane_t(axis, cell_[axis] + (ray_->step(axis) > 0 ? 1 : 0));
    }
    const double t = std::min({crossings.x, crossings.y, crossings.z});
    for (int axis = 0; axis < 3; ++axis) {
      if (crossings[axis] == t) cell_[axis] += ray_->step(axis);
    }
    return t;
  }

 private:
  const CellRay* ray_;
  glm::ivec3 cell_{0};
};

/// Calls `visit(leaf, exit_t)` for the leaves that the ray passes through, from t_min on, until
/// `visit` returns true or the ray leaves the root. The leaves, their order and their exits are the
/// same as in every other search.
template <class Cursor, class Counting, class Visit>
void walk_leaves(const typename Cursor::Tree& octree, const IterativeSearch<Cursor>&,
                 const Ray& ray, Counting& counting, Visit visit) {
  const CellRay planes(octree.grid(), ray);
  double t = planes.enter(ray.t_min);
  if (!(t < kInfinity)) return;
  CellSteps steps(planes, t);
  while (steps.is_in(glm::ivec3(0), octree.grid().cells)) {
    Cursor leaf(octree);
    std::uint64_t passed = 1;
    for (; !leaf.is_leaf(); ++passed) {
      const glm::ivec3 split = leaf.split();
      std::uint32_t octant = 0;
      for (int axis = 0; axis < 3; ++axis) {
        if (steps.cell()[axis] >= split[axis]) octant |= 1U << static_cast<unsigned>(axis);
      }
      leaf.enter(octant);
    }
    counting.add(Counter::kTraversalSteps, passed);
    const glm::ivec3 end = leaf.corner() + leaf.size();
    double exit_t = t;
    std::uint64_t crossed = 0;
    while (steps.is_in(leaf.corner(), end)) {
      exit_t = steps.step();
      ++crossed;
    }
    counting.add(kPlaneSteps, crossed);
    enter_leaf(leaf, ray, t, exit_t, octree, counting);
    if (visit(leaf.node(), exit_t)) return;
    t = exit_t;
  }
}

}  // namespace beambench::accel::octree

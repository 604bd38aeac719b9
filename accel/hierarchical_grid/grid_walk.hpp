#pragma once
// The undivided voxels of a hierarchy of grids along a ray, in order.

#include <algorithm>
#include <cstddef>

#include "accel/core/ray.hpp"
#include "accel/core/trace_step.hpp"
#include "accel/core/work_counters.hpp"
#include "accel/grid/voxel_walk.hpp"
#include "accel/hierarchical_grid/grid_hierarchy.hpp"

namespace beambench::accel::hierarchical_grid {

/// Traverses each grid as Amanatides and Woo do (1987; `grid::walk_part`). A divided voxel's grid
/// is traversed from the t at which the ray enters the voxel to the t at which the ray leaves it
/// (Jevans and Wyvill 1989).
///
/// Rounding loses no hit, as `walk_part` shows for one grid. If a point of a voxel's interval is
/// outside the voxel, it is equally far outside the adjacent voxel of the inner grid, so the
/// distances do not add up across levels.
template <class Counting, class Visit>
class GridWalk {
 public:
  /// Calls `visit(references, exit_t)` for undivided voxels with references until `visit` returns
  /// true. Empty voxels need no call: an earlier hit lies in a voxel that refers to the hit
  /// primitive.
  GridWalk(const GridHierarchy& hierarchy, const Ray& ray, Counting& counting, Visit visit)
      : hierarchy_(&hierarchy), counting_(&counting), visit_(visit), ray_(ray) {}

  /// Starts at t_min.
  void operator()() { from(-kInfinity); }

  /// Starts at t, but not before t_min.
  void from(double t) {
    grid::WalkInterval inside = grid::interval_inside(hierarchy_->top().place(), ray_);
    inside.enter = std::max(inside.enter, t);
    if (!inside.empty()) walk(hierarchy_->top(), inside);
  }

 private:
  /// Walks through part of a grid. Returns whether `visit` returned true.
  bool walk(const NestedGrid& grid, const grid::WalkInterval& part) {
    const Voxel* const voxels = hierarchy_->voxels() + grid.first_voxel;
    return grid::walk_part(
        grid.walk, ray_,
        part, [&](std::size_t index, double enter_t, double exit_t) __attribute__((always_inline)) {
          const Voxel voxel = voxels[index];
          count_step(grid, voxel, index, {enter_t, exit_t});
          if (voxel.is_divided()) {
            return walk(hierarchy_->grids()[voxel.grid()], {enter_t, exit_t});
          }
          counting_->add(Counter::kLeaves);
          counting_->add(Counter::kEmptyLeaves, voxel.is_empty() ? 1 : 0);
          return !voxel.is_empty() && test(voxel, exit_t);
        });
  }

  /// Not inlined, to keep the loop short.
  [[gnu::noinline]] bool test(Voxel voxel, double exit_t) {
    return visit_(hierarchy_->references(voxel), exit_t);
  }

  void count_step(const NestedGrid& grid, Voxel voxel, std::size_t index,
                  const grid::WalkInterval& part) {
    counting_->add(Counter::kTraversalSteps);
    counting_->enter([&] {
      return TraceStep{.place = voxel.is_divided() ? "node" : "leaf",
                       .index = grid.first_voxel + index,
                       .level = grid.level + 1,
                       .box = grid.place().box(grid::voxel_at(grid.place(), index), 1),
                       .t_enter = std::max(part.enter, static_cast<double>(ray_.t_min)),
                       .t_exit = part.exit};
    });
  }

  const GridHierarchy* hierarchy_;
  Counting* counting_;
  Visit visit_;
  grid::WalkRay ray_;
};

}  // namespace beambench::accel::hierarchical_grid

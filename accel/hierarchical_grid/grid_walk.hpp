#pragma once
// The undivided voxels of a hierarchy of grids along a ray, in order.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "accel/core/ray.hpp"
#include "accel/core/trace_step.hpp"
#include "accel/core/work_counters.hpp"
#include "accel/grid/voxel_walk.hpp"
#include "accel/hierarchical_grid/grid_hierarchy.hpp"

namespace beambench::accel::hierarchical_grid {

/// The traversal of Amanatides and Woo (1987; `grid::walk_voxels`) in each grid, a divided voxel
/// being traversed from the t at which the ray enters it to the t at which it leaves it (Jevans and
/// Wyvill 1989).
///
/// No hit is lost by rounding. In one grid that follows as for `walk_voxels`: the intervals of t
/// follow each other without a gap, and the point at a t of an interval lies less than 2^-36
/// diagonals outside the voxel. A grid in a voxel divides the interval of that voxel: its first
/// voxel begins with it, its last ends with it. Where the point at an end is outside the voxel, it
/// is as far outside the inner voxel next to it, so the distance does not add up over the levels.
template <class Counting, class Visit>
class GridWalk {
 public:
  /// `visit(references, exit_t)` is called for undivided voxels until it returns true.
  GridWalk(const GridHierarchy& hierarchy, const Ray& ray, Counting& counting, Visit visit)
      : hierarchy_(&hierarchy), counting_(&counting), visit_(visit), t_min_(ray.t_min) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<int>(axis);
      origin_[axis] = ray.origin[i];
      direction_[axis] = ray.direction[i];
      inverse_[axis] = 1.0 / direction_[axis];
      step_[axis] = ray.direction[i] > 0.0F ? 1 : (ray.direction[i] < 0.0F ? -1 : 0);
    }
  }

  /// From t_min on.
  void operator()() {
    const CellGrid& place = hierarchy_->top().place;
    // Rounded down, for a hit's t may round up to t_min.
    double enter_t = std::nextafter(t_min_, -kInfinity);
    double exit_t = kNever;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<int>(axis);
      const double lower = place.plane(i, 0);
      const double upper = place.plane(i, place.cells[i]);
      if (step_[axis] == 0) {
        if (origin_[axis] < lower || origin_[axis] > upper) return;
        continue;
      }
      const double t_lower = (lower - origin_[axis]) * inverse_[axis];
      const double t_upper = (upper - origin_[axis]) * inverse_[axis];
      enter_t = std::max(enter_t, std::min(t_lower, t_upper));
      exit_t = std::min(exit_t, std::max(t_lower, t_upper));
    }
    if (enter_t <= exit_t) walk(hierarchy_->top(), enter_t, exit_t);
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  /// Returns whether `visit` did.
  bool walk(const NestedGrid& grid, double enter_t, double end_t) {
    const CellGrid& place = grid.place;
    const std::array<std::ptrdiff_t, 3> strides{
        1, place.cells.x, static_cast<std::ptrdiff_t>(place.cells.x) * place.cells.y};
    std::array<double, 3> next_t{};
    std::array<double, 3> delta_t{};
    std::array<std::ptrdiff_t, 3> stride{};
    std::array<std::int32_t, 3> steps_left{};
    const Voxel* voxel = hierarchy_->voxels() + grid.first_voxel;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<int>(axis);
      const std::int32_t last = place.cells[i] - 1;
      const double at =
          (origin_[axis] + enter_t * direction_[axis] - place.lower[i]) * grid.cells_per_unit[i];
      const auto cell = static_cast<std::int32_t>(std::clamp(at, 0.0, static_cast<double>(last)));
      voxel += strides[axis] * cell;
      steps_left[axis] = step_[axis] > 0 ? last - cell : cell;
      next_t[axis] = kNever;
      if (step_[axis] != 0 && steps_left[axis] > 0) {
        next_t[axis] =
            (place.plane(i, step_[axis] > 0 ? cell + 1 : cell) - origin_[axis]) * inverse_[axis];
      }
      delta_t[axis] = place.cell[i] * std::abs(inverse_[axis]);
      stride[axis] = strides[axis] * step_[axis];
    }
    while (true) {
      const std::size_t nearer = next_t[0] < next_t[1] ? 0 : 1;
      const std::size_t axis = next_t[nearer] < next_t[2] ? nearer : 2;
      const double exit_t = std::min(next_t[axis], end_t);
      if (enter(grid, *voxel, voxel, enter_t, exit_t)) return true;
      if (!(next_t[axis] < end_t)) return false;
      voxel += stride[axis];
      enter_t = exit_t;
      next_t[axis] = --steps_left[axis] == 0 ? kNever : next_t[axis] + delta_t[axis];
    }
  }

  bool enter(const NestedGrid& grid, Voxel voxel, const Voxel* at, double enter_t, double exit_t) {
    counting_->add(Counter::kTraversalSteps);
    counting_->enter([&] {
      const auto index = static_cast<std::size_t>(at - hierarchy_->voxels());
      return TraceStep{
          .place = voxel.is_divided() ? "node" : "leaf",
          .index = index,
          .level = grid.level + 1,
          .box = grid.place.box(grid::voxel_at(grid.place, index - grid.first_voxel), 1),
          .t_enter = std::max(enter_t, static_cast<double>(t_min_)),
          .t_exit = exit_t};
    });
    if (voxel.is_divided()) return walk(hierarchy_->grids()[voxel.grid()], enter_t, exit_t);
    counting_->add(Counter::kLeaves);
    counting_->add(Counter::kEmptyLeaves, voxel.is_empty() ? 1 : 0);
    return visit_(hierarchy_->references(voxel), exit_t);
  }

  const GridHierarchy* hierarchy_;
  Counting* counting_;
  Visit visit_;
  float t_min_;
  std::array<double, 3> origin_;
  std::array<double, 3> direction_;
  std::array<double, 3> inverse_;
  std::array<int, 3> step_;
};

}  // namespace beambench::accel::hierarchical_grid

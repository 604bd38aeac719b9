#pragma once
// The voxels of a grid along a ray, in order.

#include <algorithm>
#include <array>
#include <cstddef>

#include "accel/core/cell_grid.hpp"
#include "accel/core/cell_ray.hpp"
#include "accel/core/trace_step.hpp"
#include "accel/core/work_counters.hpp"

namespace beambench::accel::grid {

/// The maximum number of cells along an axis. The bound below depends on it.
inline constexpr std::int32_t kMaxCellsPerAxis = 4096;

inline std::size_t voxel_count(const CellGrid& grid) {
  return static_cast<std::size_t>(grid.cells.x) * static_cast<std::size_t>(grid.cells.y) *
         static_cast<std::size_t>(grid.cells.z);
}
/// The number of a voxel, x fastest.
inline std::size_t voxel_index(const CellGrid& grid, const glm::ivec3& voxel) {
  const auto along = [](std::int32_t n) { return static_cast<std::size_t>(n); };
  return along(voxel.x) +
         along(grid.cells.x) * (along(voxel.y) + along(grid.cells.y) * along(voxel.z));
}
inline glm::ivec3 voxel_at(const CellGrid& grid, std::size_t index) {
  const auto x = static_cast<std::size_t>(grid.cells.x);
  const auto y = static_cast<std::size_t>(grid.cells.y);
  return {static_cast<std::int32_t>(index % x), static_cast<std::int32_t>(index / x % y),
          static_cast<std::int32_t>(index / x / y)};
}

/// Calls `visit(index, exit_t)` for the voxels that the ray passes through, from t_min on, until it
/// returns true or the ray leaves the grid (Amanatides and Woo, "A fast voxel traversal algorithm
/// for ray tracing", Eurographics 1987). The voxel is stepped by integers; beside it goes, for each
/// axis, the t of the next plane (their tMax), which grows by a constant (their tDelta).
///
/// These sums are not exact, yet no hit is lost. The intervals between the computed t follow each
/// other without a gap, so a hit's t lies in the interval of one voxel. After n additions tMax is
/// off by less than 2 n 2^-53 of the largest t in the grid; times the direction, and with an eye
/// within 8 scene sizes (accel/core/tolerance.hpp: 10 diagonals), the point lies at most
/// 2 x 2^12 x 2^-53 x 10 < 2^-36 diagonals outside its voxel. Overlaps are widened by 2^-30
/// diagonals, of which the canonical tests use less than 0.63.
template <class Counting, class Visit>
void walk_voxels(const CellGrid& grid, const Ray& ray, Counting& counting, Visit visit) {
  const CellRay cell_ray(grid, ray);
  double enter_t = cell_ray.enter(ray.t_min);
  if (!(enter_t < kInfinity)) return;

  const std::array<std::ptrdiff_t, 3> strides{
      1, grid.cells.x, static_cast<std::ptrdiff_t>(grid.cells.x) * grid.cells.y};
  glm::ivec3 voxel(0);
  std::array<double, 3> next_t{};
  std::array<double, 3> delta_t{};
  std::array<std::ptrdiff_t, 3> stride{};
  std::array<std::int32_t, 3> steps_left{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto slot = static_cast<std::size_t>(axis);
    voxel[axis] = cell_ray.cell_at(axis, enter_t);
    delta_t[slot] = cell_ray.delta_t(axis);
    stride[slot] = strides[slot] * cell_ray.step(axis);
    steps_left[slot] = cell_ray.step(axis) > 0 ? grid.cells[axis] - 1 - voxel[axis] : voxel[axis];
  }
  for (int axis = 0; axis < 3; ++axis) {
    next_t[static_cast<std::size_t>(axis)] = cell_ray.exit_t(axis, voxel, 1);
  }

  std::size_t index = voxel_index(grid, voxel);
  while (true) {
    const std::size_t nearer = next_t[0] < next_t[1] ? 0 : 1;
    const std::size_t axis = next_t[nearer] < next_t[2] ? nearer : 2;
    const double exit_t = next_t[axis];
    counting.add(Counter::kTraversalSteps);
    counting.add(Counter::kLeaves);
    counting.enter([&] {
      return TraceStep{.place = "leaf",
                       .index = index,
                       .box = grid.box(voxel_at(grid, index), 1),
                       .t_enter = std::max(enter_t, static_cast<double>(ray.t_min)),
                       .t_exit = exit_t};
    });
    if (visit(index, exit_t)) return;
    if (steps_left[axis]-- == 0) return;
    index = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(index) + stride[axis]);
    next_t[axis] += delta_t[axis];
    enter_t = exit_t;
  }
}

}  // namespace beambench::accel::grid

#pragma once
// The voxels of a grid along a ray, in order.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <glm/vec3.hpp>

#include "accel/core/cell_grid.hpp"
#include "accel/core/ray.hpp"
#include "accel/core/trace_step.hpp"
#include "accel/core/work_counters.hpp"

namespace beambench::accel::grid {

/// The maximum number of cells along an axis. The error bound of `walk_part` depends on it.
inline constexpr std::int32_t kMaxCellsPerAxis = 4096;

inline std::size_t voxel_count(const CellGrid& grid) {
  return static_cast<std::size_t>(grid.cells.x) * static_cast<std::size_t>(grid.cells.y) *
         static_cast<std::size_t>(grid.cells.z);
}
/// Returns the number of a voxel, x fastest.
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

/// A grid in the form needed by walks.
struct WalkGrid {
  WalkGrid() = default;
  explicit WalkGrid(const CellGrid& grid) : cells(grid), per_unit(1.0 / grid.cell) {}

  CellGrid cells;
  glm::dvec3 per_unit{1.0};  ///< cells per unit of length
};

/// A ray in the form needed by walks.
struct WalkRay {
  explicit WalkRay(const Ray& ray) : t_min(ray.t_min), t_max(ray.t_max) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float along = ray.direction[static_cast<int>(axis)];
      origin[axis] = ray.origin[static_cast<int>(axis)];
      direction[axis] = along;
      inverse[axis] = 1.0 / direction[axis];
      step[axis] = along > 0.0F ? 1 : (along < 0.0F ? -1 : 0);
    }
  }

  std::array<double, 3> origin;
  std::array<double, 3> direction;
  std::array<double, 3> inverse;
  std::array<int, 3> step;  ///< +1, -1 or 0: the direction in which the ray crosses planes
  float t_min;
  float t_max;
};

/// A part of a ray; empty if its end is before its start.
struct WalkInterval {
  double enter;
  double exit;

  bool empty() const { return !(enter <= exit); }
};

/// Returns the part of a ray in the box of a grid, from just below t_min to just above t_max,
/// because a hit's t may round to either.
inline WalkInterval interval_inside(const CellGrid& grid, const WalkRay& ray) {
  WalkInterval inside{std::nextafter(ray.t_min, -kInfinity), std::nextafter(ray.t_max, kInfinity)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<int>(axis);
    const double lower = grid.plane(i, 0);
    const double upper = grid.plane(i, grid.cells[i]);
    if (ray.step[axis] == 0) {
      if (ray.origin[axis] < lower || ray.origin[axis] > upper) return {kInfinity, -kInfinity};
      continue;
    }
    const double t_lower = (lower - ray.origin[axis]) * ray.inverse[axis];
    const double t_upper = (upper - ray.origin[axis]) * ray.inverse[axis];
    inside.enter = std::max(inside.enter, std::min(t_lower, t_upper));
    inside.exit = std::min(inside.exit, std::max(t_lower, t_upper));
  }
  return inside;
}

/// Calls `visit(index, enter_t, exit_t)` for the voxels along a part of the ray inside the grid,
/// until `visit` returns true; returns whether it did (Amanatides and Woo, "A fast voxel traversal
/// algorithm for ray tracing", Eurographics 1987). Voxels are stepped by integers, and for each
/// axis the t of the next plane (their tMax) grows by a constant (their tDelta). The axis is chosen
/// by branches: while they are predicted correctly, the comparisons of the next step need not wait
/// for those of this one.
///
/// The sums are not exact, but no hit is lost. The intervals between the computed t are contiguous
/// and cover the whole part, so a hit's t lies in the interval of one voxel. After n additions tMax
/// is off by less than 2 n 2^-53 of the largest t in the grid; times the direction, and with an eye
/// within 8 scene sizes (accel/core/tolerance.hpp: 10 diagonals), the point lies at most 2 x 2^12 x
/// 2^-53 x 10 < 2^-36 diagonals outside its voxel. Overlaps are widened by 2^-30 diagonals; the
/// canonical tests use less than 0.63 of this margin.
template <class Visit>
bool walk_part(const WalkGrid& grid, const WalkRay& ray, const WalkInterval& part, Visit visit) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const CellGrid& cells = grid.cells;
  const std::array<std::ptrdiff_t, 3> strides{
      1, cells.cells.x, static_cast<std::ptrdiff_t>(cells.cells.x) * cells.cells.y};
  std::array<double, 3> next_t{};
  std::array<double, 3> delta_t{};
  std::array<std::ptrdiff_t, 3> stride{};
  std::array<std::int32_t, 3> steps_left{};
  std::ptrdiff_t voxel = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<int>(axis);
    const std::int32_t last = cells.cells[i] - 1;
    const double at =
        (ray.origin[axis] + part.enter * ray.direction[axis] - cells.lower[i]) * grid.per_unit[i];
    const auto cell = static_cast<std::int32_t>(std::clamp(at, 0.0, static_cast<double>(last)));
    voxel += strides[axis] * cell;
    stride[axis] = strides[axis] * ray.step[axis];
    steps_left[axis] = ray.step[axis] > 0 ? last - cell : cell;
    delta_t[axis] = cells.cell[i] * std::abs(ray.inverse[axis]);
    // The faces of the grid end the part and are not crossed.
    next_t[axis] = kNever;
    if (ray.step[axis] != 0 && steps_left[axis] > 0) {
      const std::int32_t plane = ray.step[axis] > 0 ? cell + 1 : cell;
      next_t[axis] = (cells.plane(i, plane) - ray.origin[axis]) * ray.inverse[axis];
    }
  }

  double enter_t = part.enter;
  double next_x = next_t[0];
  double next_y = next_t[1];
  double next_z = next_t[2];
  // Visits the voxel and crosses the plane at `next`; returns whether the walk continues.
  bool stopped = false;
  const auto pass = [&](double& next, std::size_t axis) __attribute__((always_inline)) {
    const double exit_t = std::min(next, part.exit);
    stopped = visit(static_cast<std::size_t>(voxel), enter_t, exit_t);
    if (stopped || !(next < part.exit)) return false;
    voxel += stride[axis];
    enter_t = exit_t;
    next = --steps_left[axis] == 0 ? kNever : next + delta_t[axis];
    return true;
  };
  while (next_x < next_y && next_x < next_z ? pass(next_x, 0)
         : next_y < next_z                  ? pass(next_y, 1)
                                            : pass(next_z, 2)) {
  }
  return stopped;
}

/// Calls `visit(index, exit_t)` for the voxels that the ray passes through, from t_min on, until
/// `visit` returns true or the ray leaves the grid.
template <class Counting, class Visit>
void walk_voxels(const WalkGrid& grid, const Ray& ray, Counting& counting, Visit visit) {
  const WalkRay line(ray);
  const WalkInterval inside = interval_inside(grid.cells, line);
  if (inside.empty()) return;
  walk_part(grid, line, inside, [&](std::size_t index, double enter_t, double exit_t) {
    counting.add(Counter::kTraversalSteps);
    counting.add(Counter::kLeaves);
    counting.enter([&] {
      return TraceStep{.place = "leaf",
                       .index = index,
                       .box = grid.cells.box(voxel_at(grid.cells, index), 1),
                       .t_enter = std::max(enter_t, static_cast<double>(ray.t_min)),
                       .t_exit = exit_t};
    });
    return visit(index, exit_t);
  });
}

}  // namespace beambench::accel::grid

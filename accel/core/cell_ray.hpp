#pragma once
// The places where a ray crosses the planes of a cell grid.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "accel/core/cell_grid.hpp"
#include "accel/core/ray.hpp"

namespace beambench::accel {

/// A ray in a grid. Everything is derived from one function, `plane_t`, so that a cell's exit t and
/// its neighbor's entry t are the same number and no cell is skipped or visited twice. A ray
/// parallel to an axis always stays on one side of that axis's planes.
class CellRay {
 public:
  CellRay(const CellGrid& grid, const Ray& ray) : grid_(&grid) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto slot = static_cast<std::size_t>(axis);
      origin_[slot] = ray.origin[axis];
      direction_[slot] = ray.direction[axis];
      inverse_[slot] = 1.0 / static_cast<double>(ray.direction[axis]);
      step_[slot] = ray.direction[axis] > 0.0F ? 1 : (ray.direction[axis] < 0.0F ? -1 : 0);
    }
  }

  /// Returns the direction in which the ray crosses the planes of an axis: +1, -1 or 0.
  int step(int axis) const { return step_[static_cast<std::size_t>(axis)]; }

  /// Returns the t at which the ray crosses a plane; monotonic in `index`. The axis must not have
  /// step 0.
  [[gnu::always_inline]] double plane_t(int axis, std::int32_t index) const {
    const auto slot = static_cast<std::size_t>(axis);
    return (grid_->plane(axis, index) - origin_[slot]) * inverse_[slot];
  }

  /// Returns whether the ray at t is on the upper side of a plane. On the plane itself, it counts
  /// as being on the side toward which it moves.
  [[gnu::always_inline]] bool above(int axis, std::int32_t index, double t) const {
    switch (step(axis)) {
      case 1:
        return plane_t(axis, index) <= t;
      case -1:
        return plane_t(axis, index) > t;
      default:
        return grid_->plane(axis, index) <= origin_[static_cast<std::size_t>(axis)];
    }
  }

  /// Returns the t at which the ray leaves the cube of `size` cells at `corner` through the planes
  /// of an axis; infinite if it is parallel to them.
  [[gnu::always_inline]] double exit_t(int axis, const glm::ivec3& corner,
                                       std::int32_t size) const {
    switch (step(axis)) {
      case 1:
        return plane_t(axis, corner[axis] + size);
      case -1:
        return plane_t(axis, corner[axis]);
      default:
        return std::numeric_limits<double>::infinity();
    }
  }

  /// Returns the same for a box whose number of cells along each axis is `size`.
  [[gnu::always_inline]] double exit_t(int axis, const glm::ivec3& corner,
                                       const glm::ivec3& size) const {
    return exit_t(axis, corner, size[axis]);
  }

  /// Returns the cell along an axis that contains the ray at t, which must be in the grid.
  std::int32_t cell_at(int axis, double t) const {
    const auto slot = static_cast<std::size_t>(axis);
    const std::int32_t last = grid_->cells[axis] - 1;
    // A guess that may be off by rounding; `above` decides.
    const double guess =
        (origin_[slot] + t * direction_[slot] - grid_->lower[axis]) / grid_->cell[axis];
    auto index = static_cast<std::int32_t>(std::clamp(guess, 0.0, static_cast<double>(last)));
    while (index > 0 && !above(axis, index, t)) --index;
    while (index < last && above(axis, index + 1, t)) ++index;
    return index;
  }

  /// Returns the difference in t between consecutive planes of an axis; infinite if the ray is
  /// parallel to them.
  double delta_t(int axis) const {
    return grid_->cell[axis] * std::abs(inverse_[static_cast<std::size_t>(axis)]);
  }

  /// Returns the t at which the ray enters the grid, at least t_min (rounded down, because a hit's
  /// t may round up to t_min); infinite if it misses the grid.
  double enter(float t_min) const {
    double first = std::nextafter(t_min, -kInfinity);
    constexpr double kNever = std::numeric_limits<double>::infinity();
    double last = kNever;
    for (int axis = 0; axis < 3; ++axis) {
      const double at = origin_[static_cast<std::size_t>(axis)];
      if (step(axis) == 0) {
        if (at < grid_->plane(axis, 0) || at > grid_->plane(axis, grid_->cells[axis]))
          return kNever;
      } else {
        const double low = plane_t(axis, 0);
        const double high = plane_t(axis, grid_->cells[axis]);
        first = std::max(first, std::min(low, high));
        last = std::min(last, std::max(low, high));
      }
    }
    return first <= last ? first : kNever;
  }

 private:
  const CellGrid* grid_;
  std::array<double, 3> origin_;
  std::array<double, 3> direction_;
  std::array<double, 3> inverse_;
  std::array<int, 3> step_;
};

}  // namespace beambench::accel

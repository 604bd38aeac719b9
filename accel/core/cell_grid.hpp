#pragma once
// A box divided into equal cells with integer coordinates; the basis of octrees and voxel grids.

#include <array>
#include <cstdint>

#include <glm/vec3.hpp>

#include "accel/core/overlap.hpp"
#include "scenes/bounds.hpp"

namespace beambench::accel {

/// A box divided into `cells` equal cells along each axis. All code that needs a cell's boundary
/// calls `plane`, so that neighboring cells get the same number.
struct CellGrid {
  glm::dvec3 lower{0.0};
  glm::dvec3 cell{1.0};  ///< size of a cell
  glm::ivec3 cells{1};

  /// Returns the coordinate of the boundary below cell `index` (0 ... cells) on an axis.
  double plane(int axis, std::int32_t index) const { return lower[axis] + cell[axis] * index; }

  /// Returns the box that spans `size` cells along each axis, starting at `corner`.
  Box box(const glm::ivec3& corner, const glm::ivec3& size) const {
    Box result{};
    for (int axis = 0; axis < 3; ++axis) {
      result.lower[axis] = plane(axis, corner[axis]);
      result.upper[axis] = plane(axis, corner[axis] + size[axis]);
    }
    return result;
  }
  Box box(const glm::ivec3& corner, std::int32_t size) const {
    return box(corner, glm::ivec3(size));
  }
};

/// Makes a grid over a box of `size` around the middle of `bounds`, widened by `margin` on every
/// side. Makes a grid over the unit cube if `bounds` is empty.
CellGrid make_cell_grid(const scenes::Bounds& bounds, const glm::dvec3& size,
                        const glm::dvec3& margin, const glm::ivec3& cells);

/// Cells from `first` to `last`, both included.
struct CellRange {
  std::array<std::uint16_t, 3> first;
  std::array<std::uint16_t, 3> last;

  bool contains(const glm::ivec3& cell) const {
    return cell.x >= first[0] && cell.x <= last[0] && cell.y >= first[1] && cell.y <= last[1] &&
           cell.z >= first[2] && cell.z <= last[2];
  }
};

/// Returns the closed cells that overlap the bounds, widened by the tolerance.
CellRange cell_range(const CellGrid& grid, const scenes::Bounds& bounds, double tolerance);

}  // namespace beambench::accel

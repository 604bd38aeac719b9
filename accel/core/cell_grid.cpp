#include "accel/core/cell_grid.hpp"

#include <algorithm>

namespace beambench::accel {

namespace {

/// Returns the cell that contains a coordinate: the last one whose lower boundary is not above it.
std::int32_t cell_of(const CellGrid& grid, int axis, double coordinate) {
  const std::int32_t last = grid.cells[axis] - 1;
  // A guess that may be off by rounding; `plane` decides.
  const double guess = (coordinate - grid.lower[axis]) / grid.cell[axis];
  auto index = static_cast<std::int32_t>(std::clamp(guess, 0.0, static_cast<double>(last)));
  while (index > 0 && grid.plane(axis, index) > coordinate) --index;
  while (index < last && grid.plane(axis, index + 1) <= coordinate) ++index;
  return index;
}

}  // namespace

CellGrid make_cell_grid(const scenes::Bounds& bounds, const glm::dvec3& size,
                        const glm::dvec3& margin, const glm::ivec3& cells) {
  CellGrid grid;
  grid.cells = cells;
  if (bounds.empty()) return grid;
  const glm::dvec3 lower(bounds.lower);
  const glm::dvec3 upper(bounds.upper);
  const glm::dvec3 half = size * 0.5 + margin;
  const glm::dvec3 center = lower + (upper - lower) * 0.5;
  grid.lower = center - half;
  grid.cell = half * (2.0 / glm::dvec3(cells));
  return grid;
}

CellRange cell_range(const CellGrid& grid, const scenes::Bounds& bounds, double tolerance) {
  CellRange range{};
  for (int axis = 0; axis < 3; ++axis) {
    const double low = bounds.lower[axis] - tolerance;
    std::int32_t first = cell_of(grid, axis, low);
    if (first > 0 && grid.plane(axis, first) == low) --first;  // cells are closed
    const std::int32_t last = cell_of(grid, axis, bounds.upper[axis] + tolerance);
    const auto slot = static_cast<std::size_t>(axis);
    range.first[slot] = static_cast<std::uint16_t>(first);
    range.last[slot] = static_cast<std::uint16_t>(last);
  }
  return range;
}

}  // namespace beambench::accel

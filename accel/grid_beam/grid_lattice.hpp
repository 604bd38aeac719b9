#pragma once
// Places the grids of a hierarchy in one lattice of finest cells.

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/cell_grid.hpp"
#include "accel/hierarchical_grid/grid_hierarchy.hpp"

namespace beambench::accel::grid_beam {

/// A grid of the hierarchy in the lattice.
struct GridPlace {
  glm::ivec3 corner;  ///< its lowest finest cell
  std::int32_t size;  ///< finest cells along each edge of a voxel
};

/// If each divided voxel is divided into a power of two along each axis, the planes of all grids
/// are planes of one lattice, like those of an octree. Beams are divided by planes, which they
/// identify by their indices in that lattice, so that a plane has the same index for neighbors of
/// any size.
class GridLattice {
 public:
  /// Creates the lattice of a hierarchy built with `Inner::kPowers`.
  explicit GridLattice(const hierarchical_grid::GridHierarchy& hierarchy);

  const CellGrid& cells() const { return cells_; }
  /// Returns the place of the grid with that number.
  const GridPlace& place(std::uint32_t grid) const { return places_[grid]; }
  std::uint64_t bytes() const { return places_.capacity() * sizeof(GridPlace); }

 private:
  CellGrid cells_;
  std::vector<GridPlace> places_;
};

}  // namespace beambench::accel::grid_beam

#pragma once
// Where the grids of a hierarchy lie in one lattice of finest cells.

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/cell_grid.hpp"
#include "accel/hierarchical_grid/grid_hierarchy.hpp"

namespace beambench::accel::grid_beam {

/// A grid of the hierarchy in the lattice.
struct GridPlace {
  glm::ivec3 corner;  ///< its lowest finest cell
  std::int32_t size;  ///< of a voxel: finest cells along each of its edges
};

/// Where each voxel that is divided is divided into a power of two along each axis, the planes of
/// all grids are planes of one lattice, as those of an octree are. Beams are divided by planes and
/// name them by numbers of that lattice, so that neighbors of any size have the same number.
class GridLattice {
 public:
  /// Of a hierarchy with `Inner::kPowers`.
  explicit GridLattice(const hierarchical_grid::GridHierarchy& hierarchy);

  const CellGrid& cells() const { return cells_; }
  /// By the grids' numbers.
  const GridPlace& place(std::uint32_t grid) const { return places_[grid]; }
  std::uint64_t bytes() const { return places_.capacity() * sizeof(GridPlace); }

 private:
  CellGrid cells_;
  std::vector<GridPlace> places_;
};

}  // namespace beambench::accel::grid_beam

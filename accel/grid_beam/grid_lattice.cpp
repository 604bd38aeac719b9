#include "accel/grid_beam/grid_lattice.hpp"

#include <algorithm>
#include <cstddef>

#include "accel/grid/voxel_walk.hpp"

namespace beambench::accel::grid_beam {

GridLattice::GridLattice(const hierarchical_grid::GridHierarchy& hierarchy) {
  using hierarchical_grid::NestedGrid;
  using hierarchical_grid::Voxel;

  // The size of each grid's voxels is computed first as a share of a top voxel, then in finest
  // cells.
  const auto grids = hierarchy.grids();
  places_.resize(grids.size(), {glm::ivec3(0), 1});
  std::int32_t most = 1;
  // A grid comes after the one around it.
  const auto for_each_inner = [&](auto visit) {
    for (std::uint32_t number = 0; number < grids.size(); ++number) {
      const NestedGrid& grid = grids[number];
      for (std::size_t i = 0; i < grid::voxel_count(grid.place()); ++i) {
        const Voxel voxel = hierarchy.voxel(grid.first_voxel + i);
        if (voxel.is_divided()) visit(number, i, voxel.grid());
      }
    }
  };
  for_each_inner([&](std::uint32_t outer, std::size_t, std::uint32_t inner) {
    places_[inner].size = places_[outer].size * grids[inner].place().cells.x;
    most = std::max(most, places_[inner].size);
  });
  for (GridPlace& place : places_) place.size = most / place.size;
  for_each_inner([&](std::uint32_t outer, std::size_t i, std::uint32_t inner) {
    places_[inner].corner =
        places_[outer].corner + places_[outer].size * grid::voxel_at(grids[outer].place(), i);
  });

  cells_ = hierarchy.top().place();
  cells_.cells *= most;
  cells_.cell /= most;
}

}  // namespace beambench::accel::grid_beam

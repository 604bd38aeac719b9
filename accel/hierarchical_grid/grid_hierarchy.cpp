#include "accel/hierarchical_grid/grid_hierarchy.hpp"

#include <algorithm>

#include "accel/core/expected_visits.hpp"
#include "accel/grid/voxel_walk.hpp"

namespace beambench::accel::hierarchical_grid {

Statistics GridHierarchy::statistics() const {
  Statistics statistics;
  statistics.nodes = voxels_.size() + 1;
  for (const Voxel voxel : voxels_) {
    if (voxel.is_divided()) continue;
    ++statistics.leaves;
    if (voxel.is_empty()) {
      ++statistics.empty_leaves;
    } else {
      statistics.references += references(voxel).size();
    }
  }
  for (const NestedGrid& grid : grids_) {
    statistics.depth = std::max(statistics.depth, static_cast<std::uint64_t>(grid.level) + 1);
  }
  statistics.bytes = sizeof(*this) + grids_.capacity() * sizeof(NestedGrid) +
                     voxels_.capacity() * sizeof(Voxel) +
                     references_.capacity() * sizeof(scenes::PrimitiveId);
  statistics.more = {{"grids", static_cast<double>(grids_.size())}};
  ExpectedVisits visits(scene_bounds_);
  const CellGrid& scene = top().place();
  visits.add_node(scene.box({0, 0, 0}, scene.cells));
  for (const NestedGrid& grid : grids_) {
    for (std::size_t i = 0; i < grid::voxel_count(grid.place()); ++i) {
      const Voxel voxel = voxels_[grid.first_voxel + i];
      const Box cell = grid.place().box(grid::voxel_at(grid.place(), i), 1);
      if (voxel.is_divided()) {
        visits.add_node(cell);
      } else {
        visits.add_leaf(cell, voxel.is_empty() ? 0 : references(voxel).size());
      }
    }
  }
  visits.append_to(statistics);
  return statistics;
}

std::vector<Cell> GridHierarchy::occupied_cells() const {
  std::vector<Cell> cells;
  for (const NestedGrid& grid : grids_) {
    for (std::size_t i = 0; i < grid::voxel_count(grid.place()); ++i) {
      const Voxel voxel = voxels_[grid.first_voxel + i];
      if (voxel.is_empty() || voxel.is_divided()) continue;
      cells.push_back({grid.place().box(grid::voxel_at(grid.place(), i), 1), grid.level + 1});
    }
  }
  return cells;
}

}  // namespace beambench::accel::hierarchical_grid

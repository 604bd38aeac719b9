#include "accel/grid/eager_voxels.hpp"

#include "accel/core/least_references.hpp"
#include "accel/grid/grid_layout.hpp"
#include "accel/grid/rasterizer.hpp"
#include "accel/grid/voxel_walk.hpp"

namespace beambench::accel::grid {

EagerVoxels::EagerVoxels(const scenes::Scene& scene, const CellGrid& grid,
                         std::uint64_t max_references, Assign assign) {
  const Rasterizer rasterizer(scene, grid, assign);
  ReferenceLimit limit(max_references, scene, grid);
  std::vector<VoxelReference> found;
  found.reserve(scene.primitives.size());
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    rasterizer.for_each_voxel(id, [&](std::size_t voxel) {
      if (limit.exceeded(found.size() + 1)) {
        fail_too_many_references(scene, grid, max_references);
      }
      found.push_back({static_cast<std::uint32_t>(voxel), id});
      return true;
    });
  }
  sort_by_voxel(found, voxel_count(grid), first_, references_);
}

void EagerVoxels::describe(Statistics& statistics) const {
  const std::size_t voxels = first_.size() - 1;
  for (std::size_t voxel = 0; voxel < voxels; ++voxel) {
    if (first_[voxel] == first_[voxel + 1]) ++statistics.empty_leaves;
  }
  statistics.references = references_.size();
  statistics.bytes += first_.capacity() * sizeof(std::uint32_t) +
                      references_.capacity() * sizeof(scenes::PrimitiveId);
}

}  // namespace beambench::accel::grid

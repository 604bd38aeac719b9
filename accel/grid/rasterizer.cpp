#include "accel/grid/rasterizer.hpp"

#include <numeric>

namespace beambench::accel::grid {

/// Sorts by counting, which is stable. During the sort, first[v + 1] is the position of the next
/// reference of voxel v; at the end, it is the start of voxel v + 1.
void sort_by_voxel(const std::vector<VoxelReference>& found, std::size_t voxels,
                   std::vector<std::uint32_t>& first,
                   std::vector<scenes::PrimitiveId>& references) {
  first.assign(voxels + 1, 0);
  for (const VoxelReference& each : found) {
    if (each.voxel + 2 < first.size()) ++first[each.voxel + 2];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  references.resize(found.size());
  for (const VoxelReference& each : found) references[first[each.voxel + 1]++] = each.primitive;
}

}  // namespace beambench::accel::grid

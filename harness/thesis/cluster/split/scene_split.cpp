#include "harness/thesis/cluster/split/scene_split.hpp"

#include <utility>
#include <vector>

#include "accel/core/tolerance.hpp"
#include "harness/thesis/cluster/split/cell_costs.hpp"
#include "scenes/subset.hpp"

namespace beambench::cluster {
namespace {

/// Calls `visit(cell)` for all cells of a range.
template <class Visit>
void for_each_cell(const accel::CellRange& range, Visit visit) {
  for (int z = range.first[2]; z <= range.last[2]; ++z) {
    for (int y = range.first[1]; y <= range.last[1]; ++y) {
      for (int x = range.first[0]; x <= range.last[0]; ++x) visit(glm::ivec3(x, y, z));
    }
  }
}

}  // namespace

SceneCells::SceneCells(const scenes::Scene& scene, const accel::octree::OctreeOptions& options,
                       int level)
    : cells_(level), primitives_(cells_.count()) {
  accel::octree::OctreeOptions coarse = options;
  coarse.max_level = level;
  const accel::CellGrid grid = accel::octree::octree_grid(scene, coarse);
  ranges_.reserve(scene.primitives.size());
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    ranges_.push_back(accel::cell_range(grid, scenes::primitive_bounds(scene, id),
                                        accel::overlap_tolerance(scene)));
    for_each_cell(ranges_.back(),
                  [&](const glm::ivec3& cell) { ++primitives_[cells_.index(cell)]; });
  }
}

bool SceneCells::is_empty(const glm::ivec3& first, std::int32_t size) const {
  for (int z = first.z; z < first.z + size; ++z) {
    for (int y = first.y; y < first.y + size; ++y) {
      for (int x = first.x; x < first.x + size; ++x) {
        if (!is_empty(cells_.index({x, y, z}))) return false;
      }
    }
  }
  return true;
}

bool SceneSplit::reaches(ProcessId process, scenes::PrimitiveId id) const {
  bool found = false;
  for_each_cell(contents_.range(id), [&](const glm::ivec3& cell) {
    found = found || owner(cells().index(cell)) == process;
  });
  return found;
}

SceneSplit split_scene(const scenes::Scene& scene, const accel::octree::OctreeOptions& options,
                       const accel::PrimaryRays& rays, int level, SceneDivision division,
                       int processes) {
  SceneCells contents(scene, options, level);
  CellLoads loads{contents.primitives(), {}};
  if (needs_costs(division)) loads.costs = sampled_costs(scene, options, rays, contents);
  std::vector<std::uint16_t> owners = divide(contents.cells(), loads, division, processes);
  return {std::move(contents), std::move(owners)};
}

accel::octree::OctreePart own_cells(const SceneSplit& split, ProcessId process) {
  return {split.cells().level(),
          [&split, process](const glm::ivec3& cell) {
            return split.owner(split.cells().index(cell)) == process;
          },
          [&split](const glm::ivec3& first, std::int32_t size) {
            return !split.contents().is_empty(first, size);
          }};
}

ScenePart part_of(const scenes::Scene& scene, const SceneSplit& split, ProcessId process) {
  std::vector<scenes::PrimitiveId> kept;
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    if (split.reaches(process, id)) kept.push_back(id);
  }
  ScenePart part{scenes::subset(scene, kept), std::move(kept)};
  part.scene.bounds = scene.bounds;
  return part;
}

}  // namespace beambench::cluster

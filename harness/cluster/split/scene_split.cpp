#include "harness/cluster/split/scene_split.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "accel/core/tolerance.hpp"
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

std::uint32_t morton(const glm::ivec3& cell) {
  std::uint32_t code = 0;
  for (unsigned bit = 0; bit < 7; ++bit) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      const auto coordinate = static_cast<std::uint32_t>(cell[static_cast<int>(axis)]);
      code |= (coordinate >> bit & 1U) << (3 * bit + axis);
    }
  }
  return code;
}

}  // namespace

SceneSplit::SceneSplit(const scenes::Scene& scene, const accel::octree::OctreeOptions& options,
                       int level, int processes)
    : level_(level), cells_(1 << (level - 1)) {
  accel::octree::OctreeOptions coarse = options;
  coarse.max_level = level;
  const accel::CellGrid grid = accel::octree::octree_grid(scene, coarse);
  const auto count = static_cast<std::size_t>(cells_) * static_cast<std::size_t>(cells_) *
                     static_cast<std::size_t>(cells_);
  // A little for each cell, so that empty ones are distributed, too.
  std::vector<double> weight(count, 0.01);
  ranges_.reserve(scene.primitives.size());
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    ranges_.push_back(accel::cell_range(grid, scenes::primitive_bounds(scene, id),
                                        accel::overlap_tolerance(scene)));
    for_each_cell(ranges_.back(), [&](const glm::ivec3& cell) { weight[index(cell)] += 1.0; });
  }
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {}, [&](std::uint32_t i) { return morton(cell(i)); });
  const double total = std::accumulate(weight.begin(), weight.end(), 0.0);
  owners_.resize(count);
  double before = 0.0;
  for (const std::uint32_t i : order) {
    const double middle = (before + 0.5 * weight[i]) / total;
    owners_[i] = static_cast<std::uint16_t>(
        std::min(processes - 1, static_cast<int>(middle * static_cast<double>(processes))));
    before += weight[i];
  }
}

bool SceneSplit::reaches(ProcessId process, scenes::PrimitiveId id) const {
  bool found = false;
  for_each_cell(ranges_[id],
                [&](const glm::ivec3& cell) { found = found || owner(index(cell)) == process; });
  return found;
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

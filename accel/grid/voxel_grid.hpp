#pragma once
// A uniform grid of voxels.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "accel/core/cell_search.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "accel/grid/mailboxes.hpp"
#include "accel/grid/voxel_grid_options.hpp"
#include "accel/grid/voxel_walk.hpp"
#include "scenes/primitive.hpp"

namespace beambench::accel::grid {

/// A uniform grid with the traversal of Amanatides and Woo (`walk_voxels`). `Voxels` holds the
/// lists (`EagerVoxels`, `LazyVoxels`); `Boxes` is `Mailboxes` or `NoMailboxes`. Neither affects
/// the hits.
template <class Voxels, class Boxes>
class VoxelGrid : public TraversalAccelerator<VoxelGrid<Voxels, Boxes>> {
 public:
  VoxelGrid(const scenes::Scene& scene, const VoxelGridOptions& options)
      : scene_(&scene),
        grid_(make_voxel_grid(scene, options)),
        walk_(grid_),
        voxels_(scene, grid_, options.max_references, options.assign) {}

  const CellGrid& grid() const { return grid_; }
  const Voxels& voxels() const { return voxels_; }

  Statistics statistics() const override {
    Statistics statistics;
    statistics.nodes = statistics.leaves = voxel_count(grid_);
    statistics.depth = 1;
    statistics.bytes = sizeof(*this);
    voxels_.describe(statistics);
    return statistics;
  }

  std::vector<Cell> occupied_cells() const override {
    std::vector<Cell> cells;
    for (std::size_t voxel = 0; voxel < voxel_count(grid_); ++voxel) {
      if (voxels_.holds_references(voxel)) cells.push_back({grid_.box(voxel_at(grid_, voxel), 1)});
    }
    return cells;
  }

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting& counting) const {
    ClosestHit closest(ray);
    Boxes boxes(scene_->primitives.size());
    walk_voxels(walk_, ray, counting, [&](std::size_t voxel, double exit_t) {
      return test_references(*scene_, references(voxel, counting), exit_t, counting, closest,
                             boxes);
    });
    return closest.result();
  }
  template <class Counting>
  bool find_any(const Ray& ray, Counting& counting) const {
    const CanonicalRay canonical(ray);
    Boxes boxes(scene_->primitives.size());
    bool found = false;
    walk_voxels(walk_, ray, counting, [&](std::size_t voxel, double exit_t) {
      found = any_reference_hit(*scene_, references(voxel, counting), canonical, counting, boxes);
      return found || canonical.t_max < static_cast<float>(exit_t);
    });
    return found;
  }

 private:
  template <class Counting>
  std::span<const scenes::PrimitiveId> references(std::size_t voxel, Counting& counting) const {
    const auto references = voxels_.references(voxel);
    counting.add(Counter::kEmptyLeaves, references.empty() ? 1 : 0);
    return references;
  }

  const scenes::Scene* scene_;
  CellGrid grid_;
  WalkGrid walk_;
  Voxels voxels_;
};

}  // namespace beambench::accel::grid

#pragma once
// A uniform grid of voxels.

#include "accel/core/cell_search.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "accel/grid/voxel_grid_options.hpp"
#include "accel/grid/voxel_walk.hpp"

namespace beambench::accel::grid {

/// A uniform grid with the traversal of Amanatides and Woo (`walk_voxels`). `Voxels` holds the
/// lists (`EagerVoxels`, `LazyVoxels`); `Boxes` is `Mailboxes` or `NoMailboxes`. Neither changes a
/// hit.
template <class Voxels, class Boxes>
class VoxelGrid : public TraversalAccelerator<VoxelGrid<Voxels, Boxes>> {
 public:
  VoxelGrid(const scenes::Scene& scene, const VoxelGridOptions& options)
      : scene_(&scene),
        grid_(make_voxel_grid(scene, options)),
        voxels_(scene, grid_, options.max_references) {}

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

  std::vector<Box> occupied_cells() const override {
    std::vector<Box> cells;
    for (std::size_t voxel = 0; voxel < voxel_count(grid_); ++voxel) {
      if (voxels_.holds_references(voxel)) cells.push_back(grid_.box(voxel_at(grid_, voxel), 1));
    }
    return cells;
  }

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting& counting) const {
    return closest_in_cells(*scene_, ray, counting, Boxes(scene_->primitives.size()),
                            walk(ray, counting));
  }
  template <class Counting>
  bool find_any(const Ray& ray, Counting& counting) const {
    return any_in_cells(*scene_, ray, counting, Boxes(scene_->primitives.size()),
                        walk(ray, counting));
  }

 private:
  template <class Counting>
  auto walk(const Ray& ray, Counting& counting) const {
    return [this, &ray, &counting](auto visit) {
      walk_voxels(grid_, ray, counting, [&](std::size_t voxel, double exit_t) {
        const auto references = voxels_.references(voxel);
        counting.add(Counter::kEmptyLeaves, references.empty() ? 1 : 0);
        return visit(references, exit_t);
      });
    };
  }

  const scenes::Scene* scene_;
  CellGrid grid_;
  Voxels voxels_;
};

}  // namespace beambench::accel::grid

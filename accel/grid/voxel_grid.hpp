#pragma once
// A uniform grid of voxels.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "accel/core/cell_search.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "accel/grid/voxel_grid_options.hpp"
#include "accel/grid/voxel_walk.hpp"
#include "scenes/primitive.hpp"

namespace beambench::accel::grid {

/// One ray's view of the mailboxes (Arnaldi, Priol and Bouatouch, "A new space subdivision method
/// for ray tracing CSG modelled scenes", 1987; Amanatides and Woo, 1987): each primitive remembers
/// the last ray it was tested against.
///
/// The boxes belong to the thread, because queries are const and come from several threads at once.
/// Every ray of a thread has a number of its own, whatever the structure, so the entries of other
/// structures do no harm.
class Mailboxes {
 public:
  explicit Mailboxes(std::size_t primitives) : scratch_(of_this_thread()) {
    if (scratch_.last_ray.size() < primitives) scratch_.last_ray.resize(primitives, 0);
    if (++scratch_.ray == 0) {  // all numbers are used up: start again
      std::fill(scratch_.last_ray.begin(), scratch_.last_ray.end(), 0);
      scratch_.ray = 1;
    }
  }

  /// Is it the first call for the primitive with this ray?
  bool is_first(scenes::PrimitiveId id) {
    std::uint32_t& last = scratch_.last_ray[id];
    if (last == scratch_.ray) return false;
    last = scratch_.ray;
    return true;
  }

 private:
  struct Scratch {
    std::vector<std::uint32_t> last_ray;  ///< by primitive
    std::uint32_t ray = 0;
  };
  static Scratch& of_this_thread() {
    thread_local Scratch scratch;
    return scratch;
  }

  Scratch& scratch_;
};

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
    ClosestHit closest(ray);
    Boxes boxes(scene_->primitives.size());
    walk_voxels(grid_, ray, counting, [&](std::size_t voxel, double exit_t) {
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
    walk_voxels(grid_, ray, counting, [&](std::size_t voxel, double exit_t) {
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
  Voxels voxels_;
};

}  // namespace beambench::accel::grid

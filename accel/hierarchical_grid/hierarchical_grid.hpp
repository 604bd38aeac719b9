#pragma once
// Individual rays through a hierarchy of grids.

#include <optional>
#include <span>
#include <vector>

#include "accel/core/cell_search.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "accel/hierarchical_grid/grid_hierarchy.hpp"
#include "accel/hierarchical_grid/grid_walk.hpp"

namespace beambench::accel::hierarchical_grid {

/// Grids in the voxels of grids, traversed by `GridWalk`. `Boxes` is `grid::Mailboxes` or
/// `NoMailboxes`, which does not affect the hits.
template <class Boxes>
class HierarchicalGrid : public TraversalAccelerator<HierarchicalGrid<Boxes>> {
 public:
  HierarchicalGrid(const scenes::Scene& scene, const HierarchicalGridOptions& options)
      : scene_(&scene), hierarchy_(scene, options) {}

  const GridHierarchy& hierarchy() const { return hierarchy_; }

  Statistics statistics() const override { return hierarchy_.statistics(); }
  std::vector<Cell> occupied_cells() const override { return hierarchy_.occupied_cells(); }

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting& counting) const {
    ClosestHit closest(ray);
    Boxes boxes(scene_->primitives.size());
    GridWalk(hierarchy_, ray, counting,
             [&](std::span<const scenes::PrimitiveId> references, double exit_t) {
               return test_references(*scene_, references, exit_t, counting, closest, boxes);
             })();
    return closest.result();
  }
  template <class Counting>
  bool find_any(const Ray& ray, Counting& counting) const {
    const CanonicalRay canonical(ray);
    Boxes boxes(scene_->primitives.size());
    bool found = false;
    GridWalk(hierarchy_, ray, counting,
             [&](std::span<const scenes::PrimitiveId> references, double exit_t) {
               found = any_reference_hit(*scene_, references, canonical, counting, boxes);
               return found || canonical.t_max < static_cast<float>(exit_t);
             })();
    return found;
  }

 private:
  const scenes::Scene* scene_;
  GridHierarchy hierarchy_;
};

}  // namespace beambench::accel::hierarchical_grid

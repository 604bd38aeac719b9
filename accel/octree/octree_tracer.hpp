#pragma once
// Individual rays through the thesis's octree.

#include "accel/core/cell_search.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "accel/octree/leaf_walk.hpp"
#include "accel/octree/octree.hpp"

namespace beambench::accel::octree {

/// The octree of the thesis (section 3.3) for individual rays. `Neighbors` is how the way from a
/// leaf to the next is found (see `walk_leaves`), made from the octree; it changes no leaf, no
/// order and no hit.
template <class Neighbors>
class OctreeTracer : public TraversalAccelerator<OctreeTracer<Neighbors>> {
 public:
  OctreeTracer(const scenes::Scene& scene, const OctreeOptions& options)
      : OctreeTracer(scene, Octree(scene, options)) {}
  OctreeTracer(const scenes::Scene& scene, Octree octree)
      : scene_(&scene), octree_(std::move(octree)), neighbors_(octree_) {}

  const Octree& octree() const { return octree_; }
  const Neighbors& neighbors() const { return neighbors_; }

  Statistics statistics() const override {
    Statistics statistics = octree_.statistics();
    neighbors_.describe(statistics);
    return statistics;
  }

  std::vector<Box> occupied_cells() const override { return octree_.occupied_cells(); }

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting& counting) const {
    return closest_in_cells(*scene_, ray, counting, NoMailboxes{}, walk(ray, counting));
  }
  template <class Counting>
  bool find_any(const Ray& ray, Counting& counting) const {
    return any_in_cells(*scene_, ray, counting, NoMailboxes{}, walk(ray, counting));
  }

 private:
  template <class Counting>
  auto walk(const Ray& ray, Counting& counting) const {
    return [this, &ray, &counting](auto visit) {
      walk_leaves(octree_, neighbors_, ray, counting, [&](const OctreeNode& leaf, double exit_t) {
        return visit(octree_.references(leaf), exit_t);
      });
    };
  }

  const scenes::Scene* scene_;
  Octree octree_;
  Neighbors neighbors_;
};

}  // namespace beambench::accel::octree

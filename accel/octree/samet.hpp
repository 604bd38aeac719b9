#pragma once
// Individual rays through the thesis's octree.

#include "accel/intersect.hpp"
#include "accel/octree/octree.hpp"
#include "accel/octree/samet_walk.hpp"
#include "accel/traversal_accelerator.hpp"

namespace beambench {

/// The octree of the thesis (section 3.3) with Samet's traversal (`walk_leaves`).
class Samet : public TraversalAccelerator<Samet> {
 public:
  Samet(const Scene& scene, const OctreeOptions& options)
      : scene_(&scene), octree_(scene, options) {}

  const Octree& octree() const { return octree_; }
  Statistics statistics() const override { return octree_.statistics(); }

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting& counting) const {
    ClosestHit closest(ray);
    walk_leaves(octree_, ray, counting, [&](const OctreeNode& leaf, double exit_t) {
      for (const PrimitiveId id : octree_.references(leaf)) {
        counting.tested(id, closest.test(*scene_, id));
      }
      counting.add(Counter::kPrimitiveTests, leaf.count);
      // Strictly: a hit at the exit's own rounded t may lie behind it and have a lower id.
      return closest.ray.t_max < static_cast<float>(exit_t);
    });
    return closest.result();
  }

  template <class Counting>
  bool find_any(const Ray& ray, Counting& counting) const {
    const CanonicalRay canonical(ray);
    bool found = false;
    walk_leaves(octree_, ray, counting, [&](const OctreeNode& leaf, double exit_t) {
      for (const PrimitiveId id : octree_.references(leaf)) {
        counting.add(Counter::kPrimitiveTests);
        found = is_hit(intersect(canonical, *scene_, id));
        if (found) return true;
      }
      return canonical.t_max < static_cast<float>(exit_t);
    });
    return found;
  }

 private:
  const Scene* scene_;
  Octree octree_;
};

}  // namespace beambench

#pragma once
// Samet's traversal of an octree.

#include <algorithm>

#include "accel/intersect.hpp"
#include "accel/octree/octree.hpp"
#include "accel/octree/octree_cursor.hpp"
#include "accel/octree/octree_ray.hpp"
#include "accel/traversal_accelerator.hpp"

namespace beambench {

/// Individual rays through the thesis's octree (Samet, "Implementing ray tracing with octrees and
/// neighbor finding", 1989; thesis, sections 2.2.2 and 5.4.1): in each leaf the exit point is
/// computed, and the neighbour behind it is found over the nearest common ancestor. A ray that
/// leaves through an edge or a vertex goes to the edge or vertex neighbour.
class Samet : public TraversalAccelerator<Samet> {
 public:
  Samet(const Scene& scene, const OctreeOptions& options)
      : scene_(&scene), octree_(scene, options) {}

  const Octree& octree() const { return octree_; }
  Statistics statistics() const override { return octree_.statistics(); }

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting& counting) const {
    ClosestHit closest(ray);
    visit_leaves(ray, counting, [&](std::span<const PrimitiveId> references, double exit_t) {
      for (const PrimitiveId id : references) closest.test(*scene_, id);
      counting.add(Counter::kPrimitiveTests, references.size());
      // Strictly: a hit at the exit's own rounded t may lie behind it and have a lower id.
      return closest.ray.t_max < static_cast<float>(exit_t);
    });
    return closest.result();
  }

  template <class Counting>
  bool find_any(const Ray& ray, Counting& counting) const {
    const CanonicalRay canonical(ray);
    bool found = false;
    visit_leaves(ray, counting, [&](std::span<const PrimitiveId> references, double exit_t) {
      for (const PrimitiveId id : references) {
        counting.add(Counter::kPrimitiveTests);
        found = is_hit(intersect(canonical, *scene_, id));
        if (found) return true;
      }
      return canonical.t_max < static_cast<float>(exit_t);
    });
    return found;
  }

 private:
  /// Calls `visit(references, exit_t)` for the leaves along the ray in order, until it returns true
  /// or the ray leaves the root.
  template <class Counting, class Visit>
  void visit_leaves(const Ray& ray, Counting& counting, Visit visit) const {
    const OctreeRay way(octree_.grid(), ray);
    double t = way.enter_root(ray.t_min);
    if (!(t < kInfinity)) return;
    OctreeCursor cursor(octree_);
    int levels = 1;  // the root
    while (true) {
      levels += cursor.descend(way, t);
      const OctreeNode& leaf = cursor.node();
      counting.add(Counter::kTraversalSteps, static_cast<std::uint64_t>(levels));
      counting.add(Counter::kLeaves);
      counting.add(Counter::kEmptyLeaves, leaf.count == 0 ? 1 : 0);

      const double exits[3] = {way.exit_t(0, cursor.corner(), cursor.size()),
                               way.exit_t(1, cursor.corner(), cursor.size()),
                               way.exit_t(2, cursor.corner(), cursor.size())};
      t = std::min({exits[0], exits[1], exits[2]});
      if (visit(octree_.references(leaf), t)) return;
      glm::ivec3 step(0);
      for (int axis = 0; axis < 3; ++axis) {
        if (exits[axis] == t) step[axis] = way.step(axis);
      }
      levels = 0;
      if (!cursor.move_to_neighbour(step, levels)) return;
    }
  }

  const Scene* scene_;
  Octree octree_;
};

}  // namespace beambench

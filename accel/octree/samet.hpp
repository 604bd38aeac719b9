#pragma once
// Samet's traversal of the thesis's octree, with neighbors searched or linked beforehand.

#include "accel/core/cell_search.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "accel/octree/leaf_walk.hpp"
#include "accel/octree/octree.hpp"
#include "accel/octree/octree_cursor.hpp"
#include "accel/octree/octree_net.hpp"

namespace beambench::accel::octree {

/// The octree of the thesis (section 3.3) for individual rays. `Neighbors`, made
/// from the octree, finds the leaf behind a leaf (see `walk_leaves`); it changes no leaf, no order
/// and no hit.
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
    ClosestHit closest(ray);
    walk_leaves(octree_, neighbors_, ray, counting, [&](const OctreeNode& leaf, double exit_t) {
      return test_references(*scene_, octree_.references(leaf), exit_t, counting, closest);
    });
    return closest.result();
  }
  template <class Counting>
  bool find_any(const Ray& ray, Counting& counting) const {
    const CanonicalRay canonical(ray);
    bool found = false;
    walk_leaves(octree_, neighbors_, ray, counting, [&](const OctreeNode& leaf, double exit_t) {
      found = any_reference_hit(*scene_, octree_.references(leaf), canonical, counting);
      return found || canonical.t_max < static_cast<float>(exit_t);
    });
    return found;
  }

 private:
  const scenes::Scene* scene_;
  Octree octree_;
  Neighbors neighbors_;
};

/// Samet's neighbors, over the nearest common ancestor: nothing is stored, each move climbs and
/// descends.
class AncestorNeighbors {
 public:
  explicit AncestorNeighbors(const Octree&) {}

  [[gnu::always_inline]] static int move(OctreeCursor& cursor, const glm::ivec3& step) {
    return cursor.move_to_neighbor(step);
  }
  static void describe(Statistics&) {}
};

/// Samet's traversal of the octree (Computers & Graphics 13(4), 1989).
using Samet = OctreeTracer<AncestorNeighbors>;

/// Samet's traversal with the neighbors linked beforehand (Endl and Sommer, "Classification of
/// ray-generators in uniform subdivisions and octrees for ray tracing", Computer Graphics Forum
/// 13(1), 1994; thesis, section 5.4.1).
using SametNet = OctreeTracer<OctreeNet>;

}  // namespace beambench::accel::octree

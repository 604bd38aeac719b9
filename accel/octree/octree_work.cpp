#include "accel/octree/octree_work.hpp"

#include <algorithm>

#include "accel/cell_search.hpp"
#include "accel/octree/leaf_walk.hpp"
#include "accel/octree/samet.hpp"
#include "accel/primary_rays.hpp"

namespace beambench {
namespace {

/// What a number grows or shrinks by from level to level, if it goes on as it went; `least` and
/// `most` where it can have been no more than chance.
double growth(double before, double now, double least, double most) {
  return before > 0.0 ? std::clamp(now / before, least, most) : most;
}

}  // namespace

OctreeWork count_work(const Scene& scene, const Octree& octree, const Workload& workload) {
  const PrimaryRays sample(workload.camera, 16, 8, 1);
  const AncestorNeighbours neighbours(octree);
  WorkCounters counters;
  std::size_t meet_objects = 0;
  for (int y = 0; y < sample.height(); ++y) {
    for (int x = 0; x < sample.width(); ++x) {
      const Ray ray = sample.ray(x, y, 0);
      ClosestHit closest(ray);
      bool met = false;
      walk_leaves(octree, neighbours, ray, counters, [&](const OctreeNode& leaf, double exit_t) {
        met = met || leaf.count > 0;
        return test_references(scene, octree.references(leaf), exit_t, counters, closest);
      });
      meet_objects += met ? 1 : 0;
    }
  }
  const auto a_ray = [&](std::uint64_t count) {
    return static_cast<double>(count) / static_cast<double>(sample.count());
  };
  return {.rays = static_cast<double>(workload.rays),
          .nodes = static_cast<double>(octree.nodes().size()),
          .references = static_cast<double>(octree.reference_count()),
          .steps = a_ray(counters.get(Counter::kTraversalSteps)),
          .tests = a_ray(counters.get(Counter::kPrimitiveTests)),
          .hit_share = a_ray(meet_objects)};
}

OctreeWork extrapolate(const OctreeWork& before, const OctreeWork& now) {
  OctreeWork next = now;
  next.nodes *= growth(before.nodes, now.nodes, 1.0, 8.0);
  next.references *= growth(before.references, now.references, 1.0, 8.0);
  next.steps += std::max(0.0, now.steps - before.steps);
  // A cell of half the size holds half the tests at best, of surfaces larger than it.
  next.tests *= growth(before.tests, now.tests, 0.25, 1.0);
  // Edges of twice as many cells cross in four times as many places or more; the finer the cells,
  // the nearer to it.
  next.nonterminal *= 0.75 * growth(before.nonterminal, now.nonterminal, 4.0, 14.0);
  next.occupied *= 0.85 * growth(before.occupied, now.occupied, 3.5, 8.0);
  return next;
}

}  // namespace beambench

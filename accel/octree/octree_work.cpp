#include "accel/octree/octree_work.hpp"

#include <algorithm>

#include "accel/core/cell_search.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/octree/leaf_walk.hpp"
#include "accel/octree/samet.hpp"

namespace beambench::accel::octree {
namespace {

/// What a number grows or shrinks by from level to level, if it goes on as it went; `least` and
/// `most` where it can have been no more than chance, `least` where there was nothing.
double growth(double before, double now, double least, double most) {
  return before > 0.0 ? std::clamp(now / before, least, most) : least;
}

/// The grid of rays over the image, and a stride that comes to all of them, scattered from the
/// first on.
constexpr int kColumns = 32;
constexpr int kRows = 16;
constexpr int kStride = 197;

/// Whether rays of a coarse octree, which are long ones, have told enough for how many there are
/// to trace: less than a hundredth of their work.
bool enough(int rays, const WorkCounters& counters, const Workload& workload) {
  constexpr int kLeastRays = 32;
  return rays >= kLeastRays &&
         counters.get(Counter::kTraversalSteps) + counters.get(Counter::kPrimitiveTests) >
             workload.rays / 6;
}

}  // namespace

OctreeWork count_work(const scenes::Scene& scene, const Octree& octree, const Workload& workload) {
  const PrimaryRays sample(workload.camera, kColumns, kRows, 1);
  const AncestorNeighbors neighbors(octree);
  WorkCounters counters;
  std::size_t meet_objects = 0;
  int rays = 0;
  for (; rays < kColumns * kRows && !enough(rays, counters, workload); ++rays) {
    const int at = rays * kStride % (kColumns * kRows);
    const Ray ray = sample.ray(at % kColumns, at / kColumns, 0);
    ClosestHit closest(ray);
    bool met = false;
    walk_leaves(octree, neighbors, ray, counters, [&](const OctreeNode& leaf, double exit_t) {
      met = met || leaf.count > 0;
      return test_references(scene, octree.references(leaf), exit_t, counters, closest);
    });
    meet_objects += met ? 1 : 0;
  }
  const auto a_ray = [&](std::uint64_t count) { return static_cast<double>(count) / rays; };
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
  // Edges of twice as many cells cross in four times as many places at least, and in eight times
  // as many where all cells are divided; a level deeper they mostly grow by less than they did.
  next.nonterminal *= 0.65 * growth(before.nonterminal, now.nonterminal, 7.0, 10.0);
  next.occupied *= 0.7 * growth(before.occupied, now.occupied, 4.5, 6.0);
  return next;
}

}  // namespace beambench::accel::octree

#include "accel/octree/choose_octree.hpp"

#include <algorithm>
#include <utility>

#include "accel/core/cell_search.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/octree/box_cursor.hpp"
#include "accel/octree/leaf_walk.hpp"
#include "accel/octree/root_search.hpp"
#include "accel/octree/samet.hpp"

namespace beambench::accel::octree {
namespace {

constexpr int kFirstLevel = 3;
constexpr int kLastLevel = 12;

/// An octree and the work of using it.
struct Trial {
  Octree octree;
  OctreeWork work;
};

/// Returns the typical work of the level before the first, whose work was not counted.
OctreeWork usual_work_before(const OctreeWork& first) {
  OctreeWork before = first;
  before.nodes /= 8.0;
  before.references /= 2.0;
  before.steps -= 5.0;
  before.tests *= 4.0;
  before.nonterminal /= 7.0;
  before.occupied /= 4.5;
  return before;
}

class LevelSearch {
 public:
  LevelSearch(const scenes::Scene& scene, const OctreeOptions& options, const Workload& workload,
              const TraceCost& trace_cost, const CountMore& count_more)
      : scene_(&scene),
        options_(options),
        workload_(&workload),
        trace_cost_(&trace_cost),
        count_more_(&count_more) {}

  Octree find() {
    options_.max_level = kFirstLevel;
    Trial best = tried(Octree(*scene_, options_), {});
    OctreeWork next = extrapolate(usual_work_before(best.work), best.work);
    while (promises(next, best)) {
      ++options_.max_level;
      Trial deeper = tried(Octree(*scene_, options_, best.octree), next);
      // Both octrees are already built, so only their tracing costs are compared.
      if ((*trace_cost_)(deeper.work) >= (*trace_cost_)(best.work)) break;
      next = extrapolate(best.work, deeper.work);
      best = std::move(deeper);
    }
    return std::move(best.octree);
  }

 private:
  Trial tried(Octree octree, const OctreeWork& expected) const {
    OctreeWork work = count_work(*scene_, octree, *workload_);
    if (*count_more_) (*count_more_)(octree, expected, work);
    return {std::move(octree), work};
  }

  bool promises(const OctreeWork& next, const Trial& best) const {
    constexpr double kMargin = 0.5;        // allows for errors of the extrapolation
    constexpr double kWorthTrying = 0.95;  // allows for the cost of a trial
    return options_.max_level < kLastLevel &&
           best.octree.deepest_level() == options_.max_level &&  // some nodes can still be split
           next.references < kMargin * static_cast<double>(options_.max_references) &&
           cost(next) < kWorthTrying * cost(best.work);
  }

  double cost(const OctreeWork& work) const {
    return 60.0 * work.nodes + 70.0 * work.references + (*trace_cost_)(work);
  }

  const scenes::Scene* scene_;
  OctreeOptions options_;
  const Workload* workload_;
  const TraceCost* trace_cost_;
  const CountMore* count_more_;
};

}  // namespace

double samet_trace_cost(const OctreeWork& work) {
  return work.rays * (8.4 * work.steps + 12.6 * work.tests);
}

Octree choose_octree(const scenes::Scene& scene, const OctreeOptions& options,
                     const Workload& workload, const TraceCost& trace_cost,
                     const CountMore& count_more) {
  if (options.max_level != OctreeOptions::kAutomatic) return {scene, options};
  return LevelSearch(scene, options, workload, trace_cost, count_more).find();
}

namespace {

/// Returns the factor by which a number grew from one level to the next, clamped to [lowest,
/// highest], or `lowest` if the number was 0.
double growth(double before, double now, double lowest, double highest) {
  return before > 0.0 ? std::clamp(now / before, lowest, highest) : lowest;
}

/// The grid of rays over the image, and a stride that visits all of them in scattered order.
constexpr int kColumns = 32;
constexpr int kRows = 16;
constexpr int kStride = 197;

/// Returns whether enough rays have been counted. Counting must take less than 1% of the work of
/// all rays, and rays through a coarse octree are long.
bool enough(int rays, const WorkCounters& counters, const Workload& workload) {
  constexpr int kMinRays = 32;
  return rays >= kMinRays &&
         counters.get(Counter::kTraversalSteps) + counters.get(Counter::kPrimitiveTests) >
             workload.rays / 6;
}

template <class Search>
OctreeWork count_by(const Search& search, const scenes::Scene& scene, const Octree& octree,
                    const PrimaryRays& sample, const Workload& workload) {
  WorkCounters counters;
  std::size_t meet_objects = 0;
  int rays = 0;
  for (; rays < kColumns * kRows && !enough(rays, counters, workload); ++rays) {
    const int at = rays * kStride % (kColumns * kRows);
    const Ray ray = sample.ray(at % kColumns, at / kColumns, 0);
    ClosestHit closest(ray);
    bool met = false;
    walk_leaves(octree, search, ray, counters, [&](const OctreeNode& leaf, double exit_t) {
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

}  // namespace

OctreeWork count_work(const scenes::Scene& scene, const Octree& octree, const Workload& workload) {
  const PrimaryRays sample(workload.camera, kColumns, kRows, 1);
  if (octree.has_central_planes()) {
    return count_by(AncestorNeighbors(octree), scene, octree, sample, workload);
  }
  return count_by(RootSearch<BoxCursor>(octree), scene, octree, sample, workload);
}

OctreeWork extrapolate(const OctreeWork& before, const OctreeWork& now) {
  OctreeWork next = now;
  next.nodes *= growth(before.nodes, now.nodes, 1.0, 8.0);
  next.references *= growth(before.references, now.references, 1.0, 8.0);
  next.steps += std::max(0.0, now.steps - before.steps);
  // A cell of half the size has at least half the tests, for surfaces larger than the cell.
  next.tests *= growth(before.tests, now.tests, 0.25, 1.0);
  // If the number of cells along each axis doubles, the edges of cells cross on the image at least
  // four times as often, or eight times if all cells are divided. Growth is usually smaller at the
  // next level.
  next.nonterminal *= 0.65 * growth(before.nonterminal, now.nonterminal, 7.0, 10.0);
  next.occupied *= 0.7 * growth(before.occupied, now.occupied, 4.5, 6.0);
  return next;
}

}  // namespace beambench::accel::octree

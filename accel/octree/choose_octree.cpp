#include "accel/octree/choose_octree.hpp"

#include <utility>

namespace beambench::accel::octree {
namespace {

constexpr int kFirstLevel = 3;
constexpr int kLastLevel = 12;

/// An octree with its work.
struct Trial {
  Octree octree;
  OctreeWork work;
};

/// The work of the level before the first, at which nothing was counted: what is usual.
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
      // Both are built by now.
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
    constexpr double kRoom = 0.5;          // the extrapolated number may be wrong
    constexpr double kWorthTrying = 0.95;  // trying costs something
    return options_.max_level < kLastLevel &&
           best.octree.deepest_level() == options_.max_level &&  // or nothing is left to split
           next.references < kRoom * static_cast<double>(options_.max_references) &&
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

}  // namespace beambench::accel::octree

#pragma once
// `max_level=auto`: the octree of the level that promises to be the fastest.

#include <functional>

#include "accel/octree/octree_work.hpp"

namespace beambench::accel::octree {

/// Nanoseconds that tracing individual rays is expected to take. The coefficients are those of
/// section 5.3.3 of the thesis, fitted to measured times (results/published/thesis): what matters
/// here is where their sum is least, which depends on their ratios alone.
double samet_trace_cost(const OctreeWork& work);

/// Counts what `count_work` does not; `expected` is about what it will come to, nothing at first.
using CountMore =
    std::function<void(const Octree& octree, const OctreeWork& expected, OctreeWork& work)>;
/// Nanoseconds of tracing.
using TraceCost = std::function<double(const OctreeWork& work)>;

/// The octree of `options`, where `max_level` may be automatic: levels are tried from 3 on, each
/// octree made from the one before, as long as building and tracing the next one promise to cost
/// less. Throws as
/// `Octree`, but where the level is automatic it ends before `max_references` are exceeded.
Octree choose_octree(const scenes::Scene& scene, const OctreeOptions& options,
                     const Workload& workload, const TraceCost& trace_cost,
                     const CountMore& count_more = {});

}  // namespace beambench::accel::octree

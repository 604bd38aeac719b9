#pragma once
// `max_level=auto`: finds the octree level that is expected to be the fastest.

#include <functional>

#include "accel/core/registry.hpp"
#include "accel/octree/octree.hpp"

namespace beambench::accel::octree {

/// The work of building an octree and tracing a workload through it.
struct OctreeWork {
  double rays;               ///< rays of the workload
  double nodes;              ///< nodes of the octree
  double references;         ///< references of the octree
  double steps;              ///< traversal steps per ray
  double tests;              ///< ray-primitive tests per ray
  double hit_share;          ///< share of the rays that enter an occupied leaf
  double nonterminal = 0.0;  ///< beams per image that meet an empty leaf
  double occupied = 0.0;     ///< beams per image that end at an occupied leaf
};

/// Counts the work of individual rays on a grid of 32 x 16 over the camera's image, or of only some
/// of these rays if they are expensive.
OctreeWork count_work(const scenes::Scene& scene, const Octree& octree, const Workload& workload);

/// Extrapolates the work of the next level from the work of this level and the one before.
OctreeWork extrapolate(const OctreeWork& before, const OctreeWork& now);

/// Returns the expected nanoseconds of tracing individual rays. The coefficients are those of
/// section 5.3.3 of the thesis, fitted to measured times (results/published/thesis). Only their
/// ratio affects which level has the smallest sum.
double samet_trace_cost(const OctreeWork& work);

/// Counts work that `count_work` does not; `expected` is an estimate of the result, initially zero.
using CountMore =
    std::function<void(const Octree& octree, const OctreeWork& expected, OctreeWork& work)>;
/// Returns the expected nanoseconds of tracing.
using TraceCost = std::function<double(const OctreeWork& work)>;

/// Returns the octree for `options`. If `max_level` is automatic, levels are tried from 3 on, and
/// each octree is built from the previous one, as long as building and tracing the next one are
/// expected to cost less. Throws like `Octree`, but an automatic search ends before
/// `max_references` is exceeded.
Octree choose_octree(const scenes::Scene& scene, const OctreeOptions& options,
                     const Workload& workload, const TraceCost& trace_cost,
                     const CountMore& count_more = {});

}  // namespace beambench::accel::octree

#pragma once
// Estimates the cost of tracing an image in each cell of a scene, from a few of the image's rays.

#include <vector>

#include "accel/core/primary_rays.hpp"
#include "accel/octree/octree.hpp"
#include "harness/thesis/cluster/split/scene_split.hpp"
#include "scenes/scene.hpp"

namespace beambench::cluster {

/// Returns costs by cell number, in nanoseconds of an arbitrary machine. For a sparse regular
/// sample of the image's rays, counts leaves and tests in each cell, and multiplies them by their
/// average costs. Every process computes the same counts. Builds the octree of the whole scene and
/// frees it.
std::vector<double> sampled_costs(const scenes::Scene& scene,
                                  const accel::octree::OctreeOptions& options,
                                  const accel::PrimaryRays& rays, const SceneCells& cells);

}  // namespace beambench::cluster

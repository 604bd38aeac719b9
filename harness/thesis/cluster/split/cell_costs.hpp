#pragma once
// What tracing an image costs in each cell of a scene, estimated from a few of its rays.

#include <vector>

#include "accel/core/primary_rays.hpp"
#include "accel/octree/octree.hpp"
#include "harness/thesis/cluster/split/scene_split.hpp"
#include "scenes/scene.hpp"

namespace beambench::cluster {

/// By the cells' number, in nanoseconds of one machine or another: of a sparse regular sample of
/// the image's rays, leaves and tests are counted where they are and multiplied by what they cost
/// on average. Every process counts the same. Builds the octree of the whole scene and frees it.
std::vector<double> sampled_costs(const scenes::Scene& scene,
                                  const accel::octree::OctreeOptions& options,
                                  const accel::PrimaryRays& rays, const SceneCells& cells);

}  // namespace beambench::cluster

#pragma once
// The work that an octree makes, counted on a few rays.

#include "accel/core/registry.hpp"
#include "accel/octree/octree.hpp"

namespace beambench::accel::octree {

/// What building an octree and tracing a workload through it takes.
struct OctreeWork {
  double rays;               ///< of the workload
  double nodes;              ///< of the octree
  double references;         ///< of the octree
  double steps;              ///< traversal steps a ray
  double tests;              ///< ray-primitive tests a ray
  double hit_share;          ///< rays that come to an occupied leaf, of all
  double nonterminal = 0.0;  ///< beams of the image (not a ray) that meet an empty leaf
  double occupied = 0.0;     ///< beams that end at an occupied leaf
};

/// Counts for individual rays, on a grid of 32 x 16 rays over the camera's image or, where rays
/// are much work, on some of them.
OctreeWork count_work(const scenes::Scene& scene, const Octree& octree, const Workload& workload);

/// The work of the next level, from this one's and the one before: each number goes on as it went.
OctreeWork extrapolate(const OctreeWork& before, const OctreeWork& now);

}  // namespace beambench::accel::octree

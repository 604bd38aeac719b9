#pragma once
// Counts how often rays and beams visit the nodes of an octree, by level.

#include <cstdint>
#include <vector>

#include "accel/core/accelerator.hpp"
#include "harness/rays/trace_input.hpp"

namespace beambench::rays {

/// One level of an octree. McNeill, Shah, Hebert, Lister and Grimsdale ("Performance of space
/// subdivision techniques in ray tracing", Computer Graphics Forum 11(4), 1992) count visits by
/// level; the thesis takes its level 6 from them (section 5.3.1).
struct LevelVisits {
  int level = 1;                      ///< the root has level 1
  std::uint64_t nodes = 0;            ///< leaves and interior nodes
  std::uint64_t leaves = 0;           ///< including empty ones
  std::uint64_t occupied_leaves = 0;  ///< leaves with references
  std::uint64_t node_visits = 0;  ///< pairs of a ray and a node on its path, up to its first hit
  std::uint64_t leaf_visits = 0;  ///< node visits to leaves
  std::uint64_t beams = 0;        ///< pairs of a beam of an image and a leaf on its path (`beam`)
};

/// Returns all levels, from the root to the deepest; empty for a structure without an octree.
/// Traces the rays one by one, as `samet` does, and for `beam` also as beams. Time and memory grow
/// with the number of leaves on the rays' paths.
std::vector<LevelVisits> count_level_visits(const accel::Accelerator& structure,
                                            const TraceInput& input);

}  // namespace beambench::rays

#pragma once
// Builds from the leaves up: neighbors along a Morton curve merge.

#include <span>

#include "accel/bvh/bvh_builder.hpp"

namespace beambench::accel::bvh {

/// Parallel locally-ordered clustering (Meister and Bittner, "Parallel locally-ordered clustering
/// for bounding volume hierarchy construction", 2018). Clusters stand in Morton order, at first one
/// for each box. In each round a cluster finds, among those up to `kPlocRadius` places away, the
/// one with which the common box has the least area, and merges with it if each is the other's
/// choice. Two leaves that merge become one where that costs no more.
BinaryBvh build_ploc(std::span<const scenes::Bounds> boxes, const BvhOptions& options);

/// The original has 16; 8 cost 1% in quality (Benthin and others, "PLOC++", 2022), and half of the
/// time.
inline constexpr std::size_t kPlocRadius = 8;

}  // namespace beambench::accel::bvh

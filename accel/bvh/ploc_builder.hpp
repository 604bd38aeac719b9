#pragma once
// Builds bottom-up: neighbors along a Morton curve merge.

#include <span>

#include "accel/bvh/bvh_builder.hpp"

namespace beambench::accel::bvh {

/// Builds by parallel locally-ordered clustering (Meister and Bittner, "Parallel locally-ordered
/// clustering for bounding volume hierarchy construction", 2018). Clusters are in Morton order,
/// initially one for each box. In each round a cluster finds, among those up to `kPlocRadius`
/// positions away, the one whose common box with it has the least area, and they merge if the
/// choice is mutual. Two merging leaves become one leaf if that costs no more.
BinaryBvh build_ploc(std::span<const scenes::Bounds> boxes, const BvhOptions& options);

/// The search radius in positions. The original is 16; 8 costs 1% in quality (Benthin and others,
/// "PLOC++", 2022) and takes half the time.
inline constexpr std::size_t kPlocRadius = 8;

}  // namespace beambench::accel::bvh

#pragma once
// The reference for the quality of splits: all of them are tried.

#include <span>

#include "accel/bvh/bvh_builder.hpp"

namespace beambench::accel::bvh {

/// Divides a node's items, sorted by their centers along each of the three axes, at the place where
/// the cost by the surface area heuristic is least, of all places (MacDonald and Booth, "Heuristics
/// for ray tracing using space subdivision", 1990; Wald, Boulos and Shirley, "Ray tracing
/// deformable scenes using dynamic bounding volume hierarchies", 2007). Items are sorted once;
/// divisions keep their order. Of places that cost the same, the one nearest to the middle is
/// taken.
BinaryBvh build_sweep_bvh(std::span<const scenes::Bounds> boxes, const BvhOptions& options);

}  // namespace beambench::accel::bvh

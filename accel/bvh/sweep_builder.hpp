#pragma once
// The reference builder for the quality of splits: it tries every split.

#include <span>

#include "accel/bvh/bvh_builder.hpp"

namespace beambench::accel::bvh {

/// Sorts a node's items by their centers along each of the three axes and splits them at the
/// position with the lowest SAH cost of all positions (MacDonald and Booth, "Heuristics for ray
/// tracing using space subdivision", 1990; Wald, Boulos and Shirley, "Ray tracing deformable scenes
/// using dynamic bounding volume hierarchies", 2007). Items are sorted once; splits keep their
/// order. If several positions have equal costs, the one nearest to the middle is chosen.
BinaryBvh build_sweep_bvh(std::span<const scenes::Bounds> boxes, const BvhOptions& options);

}  // namespace beambench::accel::bvh

#pragma once
// The fastest builder: divides boxes where the bits of their Morton codes change.

#include <span>

#include "accel/bvh/bvh_builder.hpp"

namespace beambench::accel::bvh {

/// Sorts boxes by the Morton codes of their centers and divides ranges at the highest bit that
/// differs (Lauterbach, Garland, Sengupta, Luebke and Manocha, "Fast BVH construction on GPUs",
/// 2009). A range of equal codes is divided in half. A subtree becomes a leaf if a leaf costs no
/// more.
BinaryBvh build_lbvh(std::span<const scenes::Bounds> boxes, const BvhOptions& options);

}  // namespace beambench::accel::bvh

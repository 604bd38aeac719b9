#pragma once
// The criterion for a voxel to refer to a primitive.

#include "scenes/base/parameters.hpp"

namespace beambench::accel::grid {

/// The part of a primitive that must overlap the voxel: its surface, or only its bounding box, as
/// in many published counts (Havran and Sixta, "Comparison of hierarchical grids", Ray Tracing News
/// 12(1), 1999).
enum class Assign { kSurface, kBounds };

/// Returns the parameter `assign`.
inline ParameterInfo assign_parameter() {
  return choice_parameter("assign", "surface", {"surface", "bbox"},
                          "the part of a primitive that must overlap a voxel that refers to it: "
                          "its surface, or only its bounding box");
}
/// Returns the parameter's value.
inline Assign assign_of(const Parameters& parameters) {
  return parameters.choice("assign") == "bbox" ? Assign::kBounds : Assign::kSurface;
}

}  // namespace beambench::accel::grid

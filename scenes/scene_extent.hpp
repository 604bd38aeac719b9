#pragma once
// How small a scene may be.

#include <string>

#include "scenes/bounds.hpp"

namespace beambench::scenes {

/// The least diagonal of a scene's box. Rounding is relative, so that a scene may have any size
/// until products of its lengths leave the range of float. By experiment (`finishes`, triangles,
/// spheres and cones, scaled down): everything is right at diagonals of 3e-12; Embree loses
/// triangles from 3e-13 on down, and cones, spheres, tile beams and the boxes of sah-bvh fail
/// between 1e-18 and 1e-21. The limit leaves a factor of a thousand.
inline constexpr double kMinExtent = 1e-9;

/// What is wrong with the size of a scene with these bounds, as a clause that says what to do;
/// empty when nothing is. A scene without primitives has no size that could be wrong.
std::string extent_fault(const Bounds& bounds);

}  // namespace beambench::scenes

#pragma once
// Newell's teapot: 32 bicubic Bezier patches.

#include <array>
#include <vector>

#include <glm/vec3.hpp>

namespace beambench::scenes::generators {

/// Control points by rows: s runs from the first row to the last, t along the rows.
using BezierPatch = std::array<std::array<glm::dvec3, 4>, 4>;

/// Rim, body, handle, spout, lid and bottom, standing on z = 0 around the z axis, the spout toward
/// +x, 3.15 high: the SPD's, not lowered by Blinn's factor of 1.3.
std::vector<BezierPatch> teapot_patches();

struct PatchPoint {
  glm::dvec3 position;
  glm::dvec3 normal;  ///< of any length; 0 where the surface has none
};
PatchPoint evaluate_patch(const BezierPatch& patch, double s, double t);

}  // namespace beambench::scenes::generators

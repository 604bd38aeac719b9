#pragma once
// How far a computed hit may lie from its primitive, by how much overlaps are widened for it, and
// how far from surfaces rays begin.

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scenes/scene.hpp"

namespace beambench::accel {

/// The numeric contract in one number.
///
/// A canonical ray-primitive test computes t in double; before it is rounded to float the point
/// origin + t * direction lies within `kHitSlack` x (distance to the farthest point involved) of
/// its primitive: the tests reject what does not (`intersect_*.hpp`). An eye within 8 scene sizes
/// is at most 10 diagonals from any primitive, and 2 x 10 x 2^-35 < 2^-30 (2: beside a corner).
///
/// Overlaps of cells and boxes with primitives are therefore widened by 2^-30 diagonals, plus what
/// double arithmetic loses on coordinates far from the origin. A traversal in double then finds the
/// primitive in the cell that holds the point of its unrounded t. Rounding to float is monotonic:
/// a traversal may stop at a cell when the best rounded t is strictly less than the cell's
/// *rounded* exit t, for a hit beyond the exit cannot round below it, and one that rounds to the
/// same t as the best (a tie, which goes to the lowest id) is still tested.
inline constexpr double kHitSlack = 0x1p-35;

/// By how much box-primitive overlaps over this scene are widened on every side, in scene units.
inline double overlap_tolerance(const scenes::Scene& scene) {
  if (scene.bounds.empty()) return 0.0;
  const glm::dvec3 lower(scene.bounds.lower);
  const glm::dvec3 upper(scene.bounds.upper);
  const glm::dvec3 largest = glm::max(glm::abs(lower), glm::abs(upper));
  const double coordinate = std::max({largest.x, largest.y, largest.z});
  return 0x1p-30 * glm::length(upper - lower) + 0x1p-48 * coordinate;
}

/// How far from a surface rays begin, along its unit normal: 64 x 2^-24 x (largest |coordinate| of
/// the scene + the distance of its box's farthest corner from the origin), four times the length
/// within which the differ cannot distinguish points. One length for all points of a scene: rays
/// that a planar mirror reflects then still come from one point, the virtual eye moved by it.
inline double surface_lift(const scenes::Scene& scene) {
  if (scene.bounds.empty()) return 0.0;
  const glm::dvec3 farthest(glm::max(glm::abs(scene.bounds.lower), glm::abs(scene.bounds.upper)));
  return 64.0 * 0x1p-24 * (double{scene.bounds.largest_coordinate()} + glm::length(farthest));
}

}  // namespace beambench::accel

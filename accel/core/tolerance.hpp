#pragma once
// How far a computed hit may lie from its primitive, how much overlaps are widened for this, and
// how far from surfaces and lights rays begin and end.

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scenes/scene.hpp"

namespace beambench::accel {

/// The numeric contract in one number.
///
/// A canonical ray-primitive test computes t in double; before it is rounded to float, the point
/// origin + t * direction lies within `kHitSlack` x (distance to the farthest point involved) of
/// its primitive: the tests reject all other points (`intersect_*.hpp`). An eye within 8 scene
/// sizes is at most 10 diagonals from any primitive, and 2 x 10 x 2^-35 < 2^-30 (the factor 2 is
/// for points beside a corner).
///
/// Overlaps of cells and boxes with primitives are therefore widened by 2^-30 diagonals, plus the
/// rounding error of double arithmetic on coordinates far from the origin. A traversal in double
/// then finds the primitive in the cell that holds the point of its unrounded t. Rounding to float
/// is monotonic: a traversal may stop at a cell when the best rounded t is strictly less than the
/// cell's *rounded* exit t, because a hit beyond the exit cannot round below it, and a hit that
/// rounds to the same t as the best (a tie, which goes to the lowest id) is still tested.
inline constexpr double kHitSlack = 0x1p-35;

/// Returns how far box-primitive overlaps in this scene are widened on every side, in scene units.
inline double overlap_tolerance(const scenes::Scene& scene) {
  if (scene.bounds.empty()) return 0.0;
  const glm::dvec3 lower(scene.bounds.lower);
  const glm::dvec3 upper(scene.bounds.upper);
  const glm::dvec3 largest = glm::max(glm::abs(lower), glm::abs(upper));
  const double coordinate = std::max({largest.x, largest.y, largest.z});
  return 0x1p-30 * glm::length(upper - lower) + 0x1p-48 * coordinate;
}

/// Returns u, the unit in which points on a ray are compared: 2^-24 x (largest |coordinate| of the
/// point + distance of the ray's origin from the coordinate origin). Floats cannot locate the point
/// much more precisely. Only the ray and the point matter, so a large primitive elsewhere has no
/// effect.
inline double float_unit(const glm::dvec3& origin, const glm::dvec3& point) {
  const glm::dvec3 size = glm::abs(point);
  return 0x1p-24 * (std::max({size.x, size.y, size.z}) + glm::length(origin));
}

/// The number of u within which two points count as one (K): about four times the worst residual
/// observed in Embree's float kernels.
inline constexpr double kUnits = 16.0;

/// Returns how far from a surface, along its normal, rays begin after a ray from `origin` met it at
/// `point`; also how far before a light at `point` its shadow rays end. It is four times the
/// distance within which the differ cannot distinguish points.
inline double surface_lift(const glm::dvec3& origin, const glm::dvec3& point) {
  return 4.0 * kUnits * float_unit(origin, point);
}

/// Returns how far from a planar mirror the reflected rays begin. The reflections of rays from one
/// point then still have a common point: the virtual eye moved by this distance. `polygons` are the
/// bounds of the mirror's polygons.
inline double mirror_lift(const scenes::Bounds& polygons) {
  if (polygons.empty()) return 0.0;
  const glm::dvec3 farthest(glm::max(glm::abs(polygons.lower), glm::abs(polygons.upper)));
  return surface_lift(farthest, farthest);
}

/// Returns the t_max of a ray from `origin` whose direction is the vector to the light: the ray
/// ends slightly before the light, so that a surface on which the light lies does not hide it.
/// Returns 0 if that would be before the origin.
inline float t_before_light(const glm::dvec3& origin, const glm::dvec3& light) {
  const double distance = glm::distance(origin, light);
  return static_cast<float>(std::max(1.0 - surface_lift(origin, light) / distance, 0.0));
}

}  // namespace beambench::accel

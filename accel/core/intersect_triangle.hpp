#pragma once
// The canonical ray-triangle test, which also defines the surface of a polygon.

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "accel/core/canonical_ray.hpp"
#include "accel/core/tolerance.hpp"

namespace beambench::accel {

/// Returns whether the point, computed on the triangle's plane, is within kHitSlack x `reach` of
/// the triangle. A ray almost parallel to the plane can pass the edge tests and still meet the
/// plane far outside, because the rounding error of the tests is divided by the cosine of the angle
/// of incidence. The box excludes points beyond an acute corner, which the three edges alone do
/// not.
inline bool near_triangle(const glm::dvec3& point, const std::array<glm::dvec3, 3>& corners,
                          const glm::dvec3& normal, double reach) {
  const double slack = kHitSlack * reach;
  const glm::dvec3 lower = glm::min(glm::min(corners[0], corners[1]), corners[2]);
  const glm::dvec3 upper = glm::max(glm::max(corners[0], corners[1]), corners[2]);
  for (int axis = 0; axis < 3; ++axis) {
    if (point[axis] < lower[axis] - slack || point[axis] > upper[axis] + slack) return false;
  }
  const double slack_squared = slack * slack * glm::dot(normal, normal);
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 edge = corners[(i + 1) % 3] - corners[i];
    const double inside = glm::dot(glm::cross(normal, edge), point - corners[i]);
    if (inside < 0.0 && inside * inside > slack_squared * glm::dot(edge, edge)) return false;
  }
  return true;
}

/// Returns the t at which the ray meets the closed, two-sided triangle if it lies in the ray's
/// interval; otherwise kMiss. The signs of the areas that the ray spans with the three edges decide
/// (Woop, Benthin and Wald 2013, in double). A corner's position in the ray's frame is computed the
/// same way for every triangle, and reversing an edge changes exactly the sign of its area, so two
/// triangles that share an edge leave no gap (-ffp-contract=off is needed for this). A ray in the
/// triangle's plane misses.
inline float intersect_triangle(const CanonicalRay& ray, const glm::vec3& v0, const glm::vec3& v1,
                                const glm::vec3& v2) {
  const glm::dvec2 a = ray.beside(v0);
  const glm::dvec2 b = ray.beside(v1);
  const glm::dvec2 c = ray.beside(v2);
  const double u = c.x * b.y - c.y * b.x;
  const double v = a.x * c.y - a.y * c.x;
  const double w = b.x * a.y - b.y * a.x;
  if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) return kMiss;

  const std::array<glm::dvec3, 3> corners{glm::dvec3(v0), glm::dvec3(v1), glm::dvec3(v2)};
  const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double along = glm::dot(normal, ray.direction);
  if (along == 0.0) return kMiss;
  const double t = glm::dot(normal, corners[0] - ray.origin) / along;
  const float accepted = ray.accept(t);
  if (!is_hit(accepted)) return kMiss;
  double reach_squared = 0.0;
  for (const glm::dvec3& corner : corners) {
    reach_squared = std::max(reach_squared, glm::dot(corner - ray.origin, corner - ray.origin));
  }
  if (!near_triangle(ray.at(t), corners, normal, std::sqrt(reach_squared))) return kMiss;
  return accepted;
}

}  // namespace beambench::accel

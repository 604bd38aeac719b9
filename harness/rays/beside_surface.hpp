#pragma once
// Where rays begin that start on a surface.

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "scenes/scene.hpp"

namespace beambench::rays {

/// How far from a surface rays begin: 64 x 2^-24 x (largest |coordinate| of the scene + |point|),
/// four times the length within which the differ cannot tell places apart.
inline double lift_at(const scenes::Scene& scene, const glm::dvec3& point) {
  return 64.0 * 0x1p-24 * (scene.bounds.largest_coordinate() + glm::length(point));
}

/// A point a little beside a surface, on the side that `normal` (unit length) points to. Nothing
/// but geometry then decides whether the surface itself is met again, and rays need no t_min.
inline glm::dvec3 beside_surface(const scenes::Scene& scene, const glm::dvec3& point,
                                 const glm::dvec3& normal) {
  return point + normal * lift_at(scene, point);
}

}  // namespace beambench::rays

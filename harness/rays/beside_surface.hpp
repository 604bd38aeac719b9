#pragma once
// Where rays begin that start on a surface.

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "scenes/scene.hpp"

namespace beambench {

/// A point a little beside a surface, on the side that `normal` (unit length) points to: 64 x 2^-24
/// x (largest |coordinate| of the scene + |point|) away, four times the length within which the
/// differ cannot tell places apart. Nothing but geometry then decides whether the surface itself is
/// met again, and rays need no t_min.
inline glm::dvec3 beside_surface(const Scene& scene, const glm::dvec3& point,
                                 const glm::dvec3& normal) {
  const double size = scene.bounds.largest_coordinate() + glm::length(point);
  return point + normal * (64.0 * 0x1p-24 * size);
}

}  // namespace beambench

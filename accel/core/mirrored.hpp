#pragma once
// What a mirror does to a direction.

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace beambench::accel {

/// Where a mirror of this unit normal sends what comes in along a direction; lengths are kept.
inline glm::dvec3 mirrored(const glm::dvec3& incoming, const glm::dvec3& normal) {
  return incoming - 2.0 * glm::dot(incoming, normal) * normal;
}

}  // namespace beambench::accel

#include "accel/core/tolerance.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace beambench::accel {

double overlap_tolerance(const scenes::Scene& scene) {
  if (scene.bounds.empty()) return 0.0;
  const glm::dvec3 lower(scene.bounds.lower);
  const glm::dvec3 upper(scene.bounds.upper);
  const glm::dvec3 largest = glm::max(glm::abs(lower), glm::abs(upper));
  const double coordinate = std::max({largest.x, largest.y, largest.z});
  return 0x1p-30 * glm::length(upper - lower) + 0x1p-48 * coordinate;
}

}  // namespace beambench::accel

#include "harness/rays/cosine_direction.hpp"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace beambench::rays {

glm::dvec3 cosine_direction(const glm::dvec3& normal, Random& random) {
  const glm::dvec3 axis =
      std::abs(normal.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  const glm::dvec3 tangent = glm::normalize(glm::cross(normal, axis));
  const double radius_2 = random.unit();
  const double radius = std::sqrt(radius_2);
  const double angle = 2.0 * std::numbers::pi * random.unit();
  return tangent * (radius * std::cos(angle)) +
         glm::cross(normal, tangent) * (radius * std::sin(angle)) +
         normal * std::sqrt(1.0 - radius_2);
}

}  // namespace beambench::rays

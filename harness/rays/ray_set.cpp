#include "harness/rays/ray_set.hpp"

#include <glm/geometric.hpp>

namespace beambench::rays {

double coherence(std::span<const accel::Ray> rays) {
  if (rays.size() < 2) return 1.0;
  double sum = 0.0;
  glm::dvec3 before = glm::normalize(glm::dvec3(rays.front().direction));
  for (const accel::Ray& ray : rays.subspan(1)) {
    const glm::dvec3 direction = glm::normalize(glm::dvec3(ray.direction));
    sum += glm::dot(before, direction);
    before = direction;
  }
  return sum / static_cast<double>(rays.size() - 1);
}

}  // namespace beambench::rays

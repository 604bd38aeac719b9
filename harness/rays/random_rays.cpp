#include "harness/rays/random_rays.hpp"

#include <glm/geometric.hpp>

#include "harness/rays/cosine_direction.hpp"
#include "scenes/core/random.hpp"

namespace beambench::rays {
namespace {

using glm::dvec3;

struct Box {
  dvec3 lower;
  dvec3 size;
};

Box widened(const scenes::Bounds& bounds) {
  const dvec3 size = dvec3(bounds.upper) - dvec3(bounds.lower);
  const double diagonal = glm::length(size);
  const double pad = diagonal > 0.0 ? 0x1p-10 * diagonal : 1.0;
  return {dvec3(bounds.lower) - pad, size + 2.0 * pad};
}

/// Enters through one of the six faces, chosen by area.
accel::Ray line_through(const Box& box, Random& random) {
  const dvec3 areas(box.size.y * box.size.z, box.size.z * box.size.x, box.size.x * box.size.y);
  const double chosen = random.uniform(0.0, areas.x + areas.y + areas.z);
  const int axis = chosen < areas.x ? 0 : chosen < areas.x + areas.y ? 1 : 2;
  const bool upper = random.below(2) == 1;

  dvec3 point = box.lower;
  for (int i = 0; i < 3; ++i) point[i] += box.size[i] * random.unit();
  point[axis] = box.lower[axis] + (upper ? box.size[axis] : 0.0);
  dvec3 inward(0.0);
  inward[axis] = upper ? -1.0 : 1.0;
  const dvec3 direction = cosine_direction(inward, random);

  accel::Ray ray;
  ray.origin = glm::vec3(point - direction * glm::length(box.size));
  ray.direction = glm::vec3(direction);
  return ray;
}

}  // namespace

std::vector<accel::Ray> random_rays(const scenes::Bounds& box, std::size_t count,
                                    std::uint64_t seed) {
  std::vector<accel::Ray> rays;
  if (box.empty()) return rays;
  const Box around = widened(box);
  Random random(seed);
  rays.reserve(count);
  while (rays.size() < count) rays.push_back(line_through(around, random));
  return rays;
}

}  // namespace beambench::rays

#include "accel/core/ray.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "scenes/base/error.hpp"

namespace beambench::accel {

namespace {

constexpr float kLargestCoordinate = 1e9F;

void require_component(const char* what, char axis, float value, float limit) {
  if (!std::isfinite(value) || std::abs(value) > limit) {
    throw InputError(
        fmt::format("ray {}.{} is {}; expected a finite number of magnitude at most {:g}", what,
                    axis, value, limit));
  }
}

}  // namespace

void require_valid(const Ray& ray) {
  for (int axis = 0; axis < 3; ++axis) {
    const char name = static_cast<char>('x' + axis);
    require_component("origin", name, ray.origin[axis], kLargestCoordinate);
    require_component("direction", name, ray.direction[axis], kLargestCoordinate);
  }
  const glm::vec3 size = glm::abs(ray.direction);
  if (std::max({size.x, size.y, size.z}) < kShortestDirection) {
    const std::string found =
        ray.direction == glm::vec3(0.0F)
            ? "zero"
            : fmt::format("({}, {}, {})", ray.direction.x, ray.direction.y, ray.direction.z);
    throw InputError(
        fmt::format("ray direction is {}; expected a component of magnitude {:g} or more: give a "
                    "longer direction",
                    found, kShortestDirection));
  }
  if (!(ray.t_min >= 0.0F) || std::isnan(ray.t_max)) {
    throw InputError(fmt::format("ray interval is [{}, {}]; expected t_min >= 0 and a number t_max",
                                 ray.t_min, ray.t_max));
  }
}

}  // namespace beambench::accel

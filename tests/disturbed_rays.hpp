#pragma once
// Rays that deviate from their samples, among rays that do not.

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "accel/core/ray.hpp"
#include "scenes/base/random.hpp"

namespace beambench::tests {

/// Changes six of `kinds` rays, each in a random way: sample, direction, origin or interval. The
/// others get directions of different lengths.
inline void disturb(std::span<accel::Ray> rays, std::span<std::uint32_t> samples,
                    std::uint64_t kinds, Random& random) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    accel::Ray& ray = rays[i];
    switch (random.below(kinds)) {
      case 0:  // the sample, to one that may have a ray
        samples[i] = samples[random.below(samples.size())];
        break;
      case 1:
        ray.direction = -ray.direction;
        break;
      case 2:
        ray.direction += glm::vec3(0.1F, -0.2F, 0.1F);
        break;
      case 3:  // also in front of the plane
        ray.origin += 0.3F * ray.direction;
        break;
      case 4:
        ray.t_max = 3.0F;
        break;
      case 5:
        ray.t_min = 2.0F;
        break;
      default:
        ray.direction *= static_cast<float>(random.uniform(0.1, 10.0));
    }
  }
}

}  // namespace beambench::tests

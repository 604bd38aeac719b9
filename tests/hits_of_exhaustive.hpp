#pragma once
// Compares a structure with exhaustive search, ray by ray.

#include <cstdint>

#include <gtest/gtest.h>

#include "accel/core/accelerator.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "scenes/base/random.hpp"
#include "tests/random_scene.hpp"

namespace beambench::tests {

/// Expects the results of exhaustive search for `rays` difficult rays, for closest-hit and any-hit
/// queries.
inline void expect_hits_of_exhaustive(const scenes::Scene& scene,
                                      const accel::Accelerator& structure, std::uint64_t seed,
                                      int rays) {
  const accel::exhaustive::Exhaustive exhaustive(scene);
  Random random(seed);
  for (int i = 0; i < rays; ++i) {
    const accel::Ray ray = random_ray(scene, random);
    const auto hit = exhaustive.closest_hit(ray, nullptr);
    ASSERT_EQ(structure.closest_hit(ray, nullptr), hit) << "ray " << i;
    ASSERT_EQ(structure.any_hit(ray, nullptr), hit.has_value()) << "ray " << i;
  }
}

}  // namespace beambench::tests

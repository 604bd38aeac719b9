// Directions of all allowed lengths: the hits are the same, and t scales with the length.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/random.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/accel/bits.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

/// Returns the exponent of the power of two of the longest component.
int exponent_of(const glm::vec3& direction) {
  const glm::vec3 size = glm::abs(direction);
  return std::ilogb(std::max({size.x, size.y, size.z}));
}

/// Returns whether the components are those of `ray` times a power of two, without loss of digits.
bool is_exactly_scaled(const Ray& scaled, const Ray& ray, float factor) {
  return scaled.direction / factor == ray.direction;
}

bool is_normal_or_zero(float value) { return value == 0.0F || std::isnormal(value); }

class DirectionLengths : public ::testing::TestWithParam<std::string> {};

TEST_P(DirectionLengths, ChangeNoHit) {
  constexpr int kShortest = -99;  // 2^-99 > 1e-30
  constexpr int kLongest = 29;    // 2 x 2^29 > 1e9, which the longest component stays below
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 20);
    const exhaustive::Exhaustive exhaustive(scene);
    const auto structure = registry().choose(parse_spec(GetParam())).build(scene);
    Random random(seed);
    for (int i = 0; i < 60; ++i) {
      Ray ray = tests::random_ray(scene, random);
      ray.t_min = 0.0F;
      ray.t_max = kInfinity;
      const auto unscaled = exhaustive.closest_hit(ray, nullptr);
      const int own = exponent_of(ray.direction);
      for (int exponent = kShortest; exponent < kLongest; exponent += 8) {
        const float factor = std::ldexp(1.0F, exponent - own);
        Ray scaled = ray;
        scaled.direction *= factor;
        ASSERT_NO_THROW(require_valid(scaled));
        const auto hit = exhaustive.closest_hit(scaled, nullptr);
        ASSERT_EQ(tests::bits_of(structure->closest_hit(scaled, nullptr)), tests::bits_of(hit))
            << "ray " << i << " at 2^" << exponent;
        ASSERT_EQ(structure->any_hit(scaled, nullptr), hit.has_value());
        if (!is_exactly_scaled(scaled, ray, factor)) continue;
        ASSERT_EQ(hit.has_value(), unscaled.has_value()) << "ray " << i << " at 2^" << exponent;
        if (!hit) continue;
        EXPECT_EQ(hit->primitive, unscaled->primitive);
        if (is_normal_or_zero(hit->t)) {
          EXPECT_EQ(hit->t * factor, unscaled->t);
        }
      }
    }
  }
}

/// A sphere is a billion units away, and directions are so short that t would be 1e39.
TEST_P(DirectionLengths, NeverHitBeyondTheLargestFloat) {
  scenes::SceneBuilder builder("far");
  builder.add_sphere({9e8, 0.0, 0.0}, 1e6);
  builder.add_polygon(
      std::vector<glm::dvec3>{{9.5e8, -1e6, -1e6}, {9.5e8, 1e6, -1e6}, {9.5e8, 0.0, 1e6}});
  builder.add_cone({9.6e8, -1e6, 0.0}, 1e6, {9.6e8, 1e6, 0.0}, 1e6);
  const scenes::Scene scene = std::move(builder).build();
  const auto structure = registry().choose(parse_spec(GetParam())).build(scene);
  Ray ray{{0.0F, 1.0F, 1.0F}, 0.0F, {kShortestDirection, 0.0F, 0.0F}, kInfinity};
  require_valid(ray);
  for (const float t_max : {kInfinity, std::numeric_limits<float>::max()}) {
    ray.t_max = t_max;
    EXPECT_EQ(structure->closest_hit(ray, nullptr), std::nullopt);
    EXPECT_FALSE(structure->any_hit(ray, nullptr));
  }
  ray.direction *= 16.0F;
  const auto hit = structure->closest_hit(ray, nullptr);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->primitive, 0U);
  EXPECT_LT(hit->t, kInfinity);
  EXPECT_TRUE(structure->any_hit(ray, nullptr));
}

INSTANTIATE_TEST_SUITE_P(All, DirectionLengths, ::testing::ValuesIn(tests::exact_structures()),
                         tests::name_of_structure);

}  // namespace
}  // namespace beambench::accel

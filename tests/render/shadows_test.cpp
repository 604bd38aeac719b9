// All shadow methods find the same shadows.

#include "harness/render/shadows.hpp"

#include <array>

#include <gtest/gtest.h>

#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"
#include "tests/drawn.hpp"

namespace beambench::render {
namespace {

constexpr std::array kOtherWays{ShadowMethod::kCache, ShadowMethod::kLightBuffer};

TEST(Whitted, AllShadowMethodsReturnTheSameBits) {
  const auto compare = [](const scenes::Scene& scene) {
    const WhittedPicture expected = picture(scene, "sah-bvh", {});
    for (const ShadowMethod method : kOtherWays) {
      const WhittedPicture found = picture(scene, "sah-bvh", {.shadows = method});
      expect_same_bits(found.image, expected.image);
      EXPECT_EQ(found.census.shadow, expected.census.shadow);
      EXPECT_EQ(found.census.shadow_hidden, expected.census.shadow_hidden);
    }
  };
  for (std::uint64_t seed = 1; seed <= 23; seed += 2) {  // without glass
    SCOPED_TRACE(seed);
    compare(scene_of_all_surfaces(seed));
  }
  for (const char* name : {"mount:n=3", "finishes"}) {  // with glass that nothing touches
    SCOPED_TRACE(name);
    compare(scenes::load_scene(name));
  }
}

TEST(Whitted, ShadowMethodsDifferOnlyWhereSomethingTouchesGlass) {
  for (std::uint64_t seed = 2; seed <= 24; seed += 2) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = scene_of_all_surfaces(seed);
    const RayCensus expected = picture(scene, "sah-bvh", {}).census;
    for (const ShadowMethod method : kOtherWays) {
      const RayCensus found = picture(scene, "sah-bvh", {.shadows = method}).census;
      EXPECT_NEAR(static_cast<double>(found.shadow_hidden),
                  static_cast<double>(expected.shadow_hidden), 0.02 * 40 * 30);
      EXPECT_LT(found.shadow_queries, expected.shadow_queries);
    }
  }
}

TEST(LightBuffer, AgreesWithASearchOfAllPrimitives) {
  std::size_t hidden = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 50);
    Random random(seed);
    const auto structure = built(scene, "exhaustive");
    const glm::vec3 light = tests::random_ray(scene, random).origin;
    const LightBuffer buffer(scene, light, 1 + static_cast<int>(random.below(40)));
    for (int i = 0; i < 300; ++i) {
      accel::Ray ray;
      ray.origin = tests::random_ray(scene, random).origin;
      ray.direction = light - ray.origin;
      ray.t_max = 1.0F;
      if (ray.direction == glm::vec3(0.0F)) continue;
      std::uint64_t tests = 0;
      const bool expected = structure->any_hit(ray, nullptr);
      hidden += expected ? 1 : 0;
      ASSERT_EQ(buffer.visibility(ray, tests),
                expected ? LightBuffer::Visibility::kHidden : LightBuffer::Visibility::kFree)
          << "ray " << i;
    }
  }
  EXPECT_GT(hidden, 1000U);
}

TEST(LightBuffer, TestsFewerPrimitivesThanThereAre) {
  const scenes::Scene scene = scenes::load_scene("balls:n=3");
  const WhittedPicture found = picture(scene, "sah-bvh", {.shadows = ShadowMethod::kLightBuffer});
  EXPECT_EQ(found.census.shadow_listed, found.census.shadow);
  EXPECT_LT(found.census.shadow_tests, 20 * found.census.shadow);
}

TEST(ShadowMethods, AreNamed) {
  for (const std::string_view name : shadow_method_names()) {
    EXPECT_EQ(shadow_method_names()[static_cast<std::size_t>(parse_shadow_method(name))], name);
  }
  EXPECT_THROW(parse_shadow_method("guess"), InputError);
}

TEST(ShadowMethods, AreThoseOfTheKindOfRays) {
  for (const std::string_view name : shadow_method_names()) {
    const rays::RayChoice choice =
        rays::parse_ray_choice("whitted:depth=3,shadows=" + std::string(name));
    const WhittedOptions options = whitted_options(choice);
    EXPECT_EQ(options.max_depth, 3);
    EXPECT_EQ(options.shadows, parse_shadow_method(name));
    EXPECT_EQ(options.min_weight, 0.0);
  }
  const WhittedOptions options = whitted_options(rays::parse_ray_choice("whitted"));
  EXPECT_EQ(options.max_depth, WhittedOptions{}.max_depth);
  EXPECT_EQ(options.batch, WhittedOptions{}.batch);
  EXPECT_EQ(whitted_options(rays::parse_ray_choice("whitted:batch=4096")).batch, 4096);
}

}  // namespace
}  // namespace beambench::render

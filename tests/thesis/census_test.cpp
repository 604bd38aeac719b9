// Properties of the census of a picture's rays.

#include "harness/thesis/census.hpp"

#include <gtest/gtest.h>

#include "scenes/catalogue.hpp"

namespace beambench::thesis {
namespace {

CensusResult census_of(const scenes::Scene& scene, const CensusOptions& options) {
  base::Progress progress(2, stderr, true);
  return take_census(accel::registry().choose(parse_spec("sah-bvh")), scene,
                     {scene.cameras.front(), {32, 24}, 1}, options, progress);
}

TEST(Census, WithoutFaintRaysIsComparedWithTheWholePicture) {
  const scenes::Scene scene = scenes::load_scene("balls:n=1");
  const CensusResult all = census_of(scene, {});
  EXPECT_EQ(all.census.eye, 32U * 24U);
  EXPECT_GT(all.census.reflected, 0U);
  EXPECT_FALSE(all.full);
  const CensusResult some = census_of(scene, {.whitted = {.min_weight = 0.3}});
  ASSERT_TRUE(some.full);
  EXPECT_EQ(some.full->rays, all.census.all_rays());
  EXPECT_LT(some.census.all_rays(), some.full->rays);
  EXPECT_GT(some.full->error, 0.0);
  EXPECT_GT(some.census.too_faint, 0U);
}

TEST(Census, BySpdRulesTracesTheCornersOfPixels) {
  const CensusResult result =
      census_of(scenes::load_scene("tetra:n=1"), {.whitted = {}, .spd_rules = true});
  EXPECT_EQ(result.census.eye, 513U * 513U);
  EXPECT_EQ(result.picture.width(), 513);
}

}  // namespace
}  // namespace beambench::thesis

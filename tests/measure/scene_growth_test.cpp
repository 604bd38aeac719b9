// Properties of the growth of a generated scene.

#include "harness/measure/scene_growth.hpp"

#include <gtest/gtest.h>

#include "scenes/base/error.hpp"

namespace beambench::measure {
namespace {

TEST(SceneGrowth, GrowsUpToTheLimit) {
  base::Progress progress(1, stderr, true);
  const SceneGrowth growth = measure_growth("tetra", 300, progress);
  EXPECT_EQ(growth.size_parameter, "n");
  ASSERT_EQ(growth.sizes.size(), 4U);
  EXPECT_EQ(growth.sizes.back().primitives, 256U);
  EXPECT_THROW(measure_growth("tetra:n=2", 300, progress), InputError);
  EXPECT_THROW(measure_growth("./file.nff", 300, progress), InputError);
}

}  // namespace
}  // namespace beambench::measure

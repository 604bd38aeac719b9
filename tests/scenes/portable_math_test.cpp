#include "scenes/base/portable_math.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace beambench::scenes {
namespace {

// Compares our functions with the library's, which are correct to one unit in the last place on our
// build machines.

TEST(PortableMath, SineAndCosine) {
  for (int i = -6000; i <= 6000; ++i) {
    const double x = 0.01 * i;
    EXPECT_NEAR(portable_sin(x), std::sin(x), 5e-16) << x;
    EXPECT_NEAR(portable_cos(x), std::cos(x), 5e-16) << x;
  }
  EXPECT_EQ(portable_sin(0.0), 0.0);
  EXPECT_EQ(portable_cos(0.0), 1.0);
  EXPECT_NEAR(portable_sin(1000.0 * std::numbers::pi), 0.0, 1e-12);
}

TEST(PortableMath, Exponential) {
  for (int i = -4000; i <= 4000; ++i) {
    const double x = 0.013 * i;
    EXPECT_NEAR(portable_exp(x) / std::exp(x), 1.0, 1e-15) << x;
  }
  EXPECT_EQ(portable_exp(0.0), 1.0);
}

TEST(PortableMath, Logarithm) {
  for (int i = 1; i <= 5000; ++i) {
    for (const double scale : {1e-9, 0.001, 1.0, 1e6}) {
      const double x = scale * i;
      EXPECT_NEAR(portable_log(x), std::log(x), 4e-16 * (1.0 + std::abs(std::log(x)))) << x;
    }
  }
  EXPECT_EQ(portable_log(1.0), 0.0);
}

}  // namespace
}  // namespace beambench::scenes

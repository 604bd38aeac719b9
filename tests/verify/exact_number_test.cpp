// The exact numbers of the judge's test.

#include <cmath>

#include <gtest/gtest.h>

#include "scenes/base/random.hpp"
#include "tests/verify/exact/number.hpp"

namespace beambench::exact {
namespace {

TEST(ExactNumber, KeepsEveryBit) {
  const Number sum = Number(0x1p100) + Number(0x1p-100);
  EXPECT_GT(sum, Number(0x1p100));
  EXPECT_EQ((sum - Number(0x1p100)).rounded(), 0x1p-100);
  EXPECT_EQ((sum.squared() - Number(0x1p200) - Number(0x1p-200)).rounded(), 2.0);
  EXPECT_EQ((Number(0.1) * Number(3.0) - Number(0.3)).rounded(), 0x1p-55);
  EXPECT_EQ(Number(-3.0).times_two_to(-4).rounded(), -0.1875);
  EXPECT_EQ(Number(0x1p-1074).rounded(), 0x1p-1074);
}

TEST(ExactNumber, AgreesWithDoublesWhereTheseAreExact) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const auto whole = [&] { return std::floor(random.uniform(-1e7, 1e7)); };
    const double a = whole();
    const double b = whole() / 1024.0;
    EXPECT_EQ((Number(a) + Number(b)).rounded(), a + b);
    EXPECT_EQ((Number(a) - Number(b)).rounded(), a - b);
    EXPECT_EQ((Number(a) * Number(b)).rounded(), a * b);
    EXPECT_EQ(Number(a) < Number(b), a < b);
    EXPECT_EQ(Number(a).sign(), (a > 0.0) - (a < 0.0));
  }
}

TEST(ExactNumber, SignWithOneRootIsExact) {
  EXPECT_EQ(sign_with_root(-3.0, 1.0, 9.0), 0);
  EXPECT_EQ(sign_with_root(-3.0, 1.0, Number(9.0) + Number(0x1p-200)), 1);
  EXPECT_EQ(sign_with_root(3.0, -1.0, Number(9.0) + Number(0x1p-200)), -1);
  EXPECT_EQ(sign_with_root(0.0, -2.0, 5.0), -1);
  EXPECT_EQ(sign_with_root(-1.0, -2.0, 0.0), -1);
  EXPECT_EQ(sign_with_root(0.0, 0.0, 5.0), 0);
}

TEST(ExactNumber, SignWithTwoRootsIsExact) {
  // sqrt(2) + sqrt(8) = sqrt(18)
  EXPECT_EQ(sign_with_roots(0.0, 1.0, 18.0, -3.0, 2.0), 0);
  EXPECT_EQ(sign_with_roots(0x1p-200, 1.0, 18.0, -3.0, 2.0), 1);
  EXPECT_EQ(sign_with_roots(-0x1p-200, 1.0, 18.0, -3.0, 2.0), -1);
  // 1 + sqrt(2) - sqrt(3 + sqrt(8)) = 0 in doubles; here -sqrt(5.8284271247461901)
  EXPECT_EQ(sign_with_roots(1.0, 1.0, 2.0, -1.0, 5.828427124746190), 1);
  EXPECT_EQ(sign_with_roots(1.0, 1.0, 2.0, -1.0, 5.828427124746191), -1);
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const auto any = [&] { return random.uniform(-4.0, 4.0); };
    const double a = any();
    const double b = any();
    const double c = any();
    const double d = std::abs(any());
    const double e = std::abs(any());
    const double value = a + b * std::sqrt(d) + c * std::sqrt(e);
    if (std::abs(value) < 1e-12) continue;
    EXPECT_EQ(sign_with_roots(a, b, d, c, e), value > 0.0 ? 1 : -1);
  }
}

TEST(ExactRoot, ComparesWithNumbersAndRoots) {
  const Root root{1.0, 1.0, 2.0, 4.0};  // (1 + sqrt(2)) / 4
  EXPECT_NEAR(root.rounded(), (1.0 + std::sqrt(2.0)) / 4.0, 1e-16);
  EXPECT_EQ(compare(root, Number(0.6035533905932737)), 1);
  EXPECT_EQ(compare(root, Number(0.6035533905932738)), -1);
  EXPECT_EQ(compare(root, Root{2.0, 1.0, 8.0, 8.0}), 0);
  EXPECT_EQ(compare(root, Root{2.0, 1.0, Number(8.0) + Number(0x1p-99), 8.0}), -1);
}

TEST(ExactRoot, IsRoundedWithoutCancellation) {
  const Root small{-0x1p60, 1.0, Number(0x1p120) + Number(2.0), 1.0};
  EXPECT_DOUBLE_EQ(small.rounded(), 0x1p-60);
}

}  // namespace
}  // namespace beambench::exact

// The tone curve chosen for a picture: what it preserves and bounds, and its effect on pictures
// that do not need one.

#include "harness/render/picture/tone.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "harness/render/picture/color.hpp"
#include "harness/render/picture/image.hpp"

namespace beambench::render {
namespace {

constexpr int kSize = 100;

/// Returns a ramp of the brightest component in many hues, spanning `stops` stops around `middle`.
Image ramp(double middle, double stops) {
  Image image(kSize, kSize);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const auto light = static_cast<float>(middle * std::exp2(stops * (x / (kSize - 1.0) - 0.5)));
      const glm::vec3 hue = id_color(static_cast<std::uint32_t>(y));
      image.at(x, y) = light / brightest(hue) * hue;
    }
  }
  return image;
}

Image toned(Image image) {
  apply(image, choose_tone(image));
  return image;
}

/// Returns the share of a PNG's pixels that have a channel at 255.
double share_clipped(const Image& image) {
  const auto clipped = std::ranges::count_if(image.pixels(), [](const glm::vec3& pixel) {
    return std::lround(255.0F * srgb_from_linear(brightest(pixel))) == 255;
  });
  return static_cast<double>(clipped) / static_cast<double>(image.pixels().size());
}

double mean_display_value(const Image& image) {
  double sum = 0.0;
  for (const glm::vec3& pixel : image.pixels()) sum += srgb_from_linear(brightest(pixel));
  return sum / static_cast<double>(image.pixels().size());
}

TEST(Tone, OfBrightPicturesLeavesOnePercentClipped) {
  for (const double middle : {1.0, 4.0, 1e4}) {
    for (const double stops : {1.0, 6.0, 20.0}) {
      const Image image = ramp(middle, stops);
      ASSERT_GT(share_clipped(image), 0.2);
      EXPECT_LE(share_clipped(toned(image)), 0.01) << middle << ", " << stops;
    }
  }
}

TEST(Tone, OfAWhiteWallIsJustBelowWhite) {
  Image image(kSize, kSize, glm::vec3(0.3F));
  std::ranges::fill(image.pixels().first(kSize * kSize / 3), glm::vec3(1.6F));
  image.at(0, 0) = glm::vec3(1e9F);
  const Image shown = toned(image);
  EXPECT_NEAR(brightest(shown.at(1, 0)), ToneCurve::kPeak, 1e-6);
  EXPECT_EQ(shown.at(0, 0), glm::vec3(1.0F));
  EXPECT_LE(share_clipped(shown), 0.01);
}

RC_GTEST_PROP(Tone, RisesWithTheLight, ()) {
  const ToneCurve curve(std::exp2(*rc::gen::inRange(-60, 60) / 10.0),
                        ToneCurve::kPeak * std::exp2(*rc::gen::inRange(0, 100) / 10.0));
  double before = curve(0.0);
  RC_ASSERT(before == 0.0);
  for (int step = -200; step < 200; ++step) {
    const double shown = curve(std::exp2(step / 10.0));
    RC_ASSERT(shown > before || (shown == 1.0 && before == 1.0));
    before = shown;
  }
  RC_ASSERT(before <= 1.0);
}

TEST(Tone, KeepsHueAndSaturation) {
  for (const double middle : {1e-3, 0.5, 8.0}) {
    const Image image = ramp(middle, 8.0);
    const Image shown = toned(image);
    for (std::size_t i = 0; i < image.pixels().size(); ++i) {
      const glm::vec3 before = image.pixels()[i] / brightest(image.pixels()[i]);
      const glm::vec3 after = shown.pixels()[i] / brightest(shown.pixels()[i]);
      ASSERT_LT(glm::distance(before, after), 1e-5F);
    }
  }
}

TEST(Tone, LeavesAWellExposedPictureUnchanged) {
  const Image image = ramp(0.25, 3.0);
  ASSERT_EQ(share_clipped(image), 0.0);
  EXPECT_EQ(choose_tone(image).stops(), 0.0);
  EXPECT_LT(root_mean_square_error(toned(image), image), 0.01);
}

TEST(Tone, OfALightBackgroundDoesNotDarkenIt) {
  Image image(kSize, kSize, glm::vec3(0.8F));
  for (int x = 0; x < kSize; ++x) image.at(x, 50) = glm::vec3(0.1F);
  EXPECT_EQ(choose_tone(image).stops(), 0.0);
}

TEST(Tone, LiftsADarkPicture) {
  const Image image = ramp(0.004, 4.0);
  const Image shown = toned(image);
  EXPECT_LT(mean_display_value(image), 0.1);
  EXPECT_GT(mean_display_value(shown), 0.3);
  EXPECT_LE(share_clipped(shown), 0.01);
}

TEST(Tone, OfAnObjectInTheDarkIsThatOfTheObject) {
  Image image(kSize, kSize);
  for (int x = 0; x < kSize / 2; ++x) image.at(x, 50) = glm::vec3(x % 2 == 0 ? 0.05F : 0.15F);
  EXPECT_NEAR(choose_tone(image).stops(), std::log2(0.09 / std::sqrt(0.05 * 0.15)), 1e-3);
  EXPECT_EQ(toned(image).at(0, 0), glm::vec3(0.0F));
}

TEST(Tone, LeavesBlackBlack) {
  const Image shown = toned(Image(kSize, kSize));
  EXPECT_TRUE(std::ranges::all_of(shown.pixels(),
                                  [](const glm::vec3& pixel) { return pixel == glm::vec3(0.0F); }));
  EXPECT_EQ(choose_tone(Image(kSize, kSize)).stops(), 0.0);
}

TEST(Tone, NeverYieldsNan) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  constexpr float kSmallest = std::numeric_limits<float>::denorm_min();
  Image image = ramp(1.0, 40.0);
  image.at(3, 3) = glm::vec3(kLargest);
  image.at(4, 3) = {0.0F, 0.0F, kLargest};
  image.at(5, 3) = {kSmallest, 0.0F, 0.0F};
  image.at(6, 3) = glm::vec3(0.0F);
  const Image shown = toned(image);
  for (const glm::vec3& pixel : shown.pixels()) {
    ASSERT_GE(std::min({pixel.x, pixel.y, pixel.z}), 0.0F);
    ASSERT_LE(brightest(pixel), 1.0F);
  }
  image.at(7, 3) = glm::vec3(std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isfinite(choose_tone(image).stops())) << "one bad pixel decides nothing";
}

}  // namespace
}  // namespace beambench::render

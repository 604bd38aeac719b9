// Noise, textures, and one hand-computed pixel for each of the thesis's surfaces.

#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "harness/render/texture.hpp"
#include "tests/drawn.hpp"

namespace beambench::render {
namespace {

using glm::dvec3;

TEST(Noise, IsZeroAtTheLatticeAndStaysInItsRange) {
  Random random(7);
  double least = 0.0;
  double most = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    const dvec3 point{random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50)};
    const double noise = gradient_noise(point);
    least = std::min(least, noise);
    most = std::max(most, noise);
    EXPECT_EQ(gradient_noise(glm::floor(point)), 0.0);
    // The noise is smooth: a step of 1e-6 changes it by about as much.
    EXPECT_NEAR(gradient_noise(point + dvec3(1e-6)), noise, 1e-5);
  }
  EXPECT_LT(most, 1.1);
  EXPECT_GT(least, -1.1);
  EXPECT_GT(most, 0.6);
  EXPECT_LT(least, -0.6);
}

TEST(Texture, VariesAboutTheColorOfItsSurface) {
  scenes::SceneBuilder builder("ball");
  builder.add_sphere({0, 0, 0}, 10.0);
  const scenes::Scene scene = std::move(builder).build();
  const TextureSpace textures(scene);
  for (int finish = 0; finish <= static_cast<int>(scenes::Finish::kWhiteMarble); ++finish) {
    SCOPED_TRACE(finish);
    const scenes::Surface surface = scenes::finished_surface(static_cast<scenes::Finish>(finish));
    const std::string_view word = scenes::finish_word(surface.finish);
    const bool texture = word.starts_with("tex") || word == "surfgranite";
    Random random(3);
    dvec3 sum(0.0);
    double spread = 0.0;
    constexpr int kPoints = 4000;
    for (int i = 0; i < kPoints; ++i) {
      const dvec3 point{random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9)};
      const dvec3 color = textures.color_at(surface, point);
      sum += color;
      spread += glm::length(color - dvec3(surface.color));
    }
    EXPECT_LT(glm::length(sum / double{kPoints} - dvec3(surface.color)), 0.3);
    if (texture) {
      EXPECT_GT(spread / kPoints, 0.02);
    } else {
      EXPECT_EQ(spread, 0.0);
    }
  }
}

/// Returns the color of a finish in the middle of its scene, where all noise is 0. There, marble
/// mixes in 1/64 of the vein's color, wood begins a ring, clouds are a smooth step, and granite
/// shows no grain.
dvec3 color_in_the_middle(scenes::Finish finish) {
  const dvec3 own(scenes::finished_surface(finish).color);
  const auto marble = [&](const dvec3& vein) { return own + (vein - own) / 64.0; };
  switch (finish) {
    case scenes::Finish::kBlackMarble:
      return marble({0.75, 0.73, 0.7});
    case scenes::Finish::kBlueMarble:
      return marble({0.88, 0.9, 0.95});
    case scenes::Finish::kRedMarble:
      return marble({0.92, 0.82, 0.78});
    case scenes::Finish::kWhiteMarble:
      return marble({0.38, 0.4, 0.44});
    case scenes::Finish::kCherryWood:
      return 1.15 * own;
    case scenes::Finish::kDarkWood:
      return 1.2 * own;
    case scenes::Finish::kPineWood:
      return 1.05 * own;
    case scenes::Finish::kClouds: {
      constexpr double kStep = 3.0 / 14.0;  // the position of 0 between -0.15 and 0.55
      return glm::mix(dvec3(0.36, 0.58, 0.9), dvec3(1.0), kStep * kStep * (3.0 - 2.0 * kStep));
    }
    default:
      return own;
  }
}

TEST(Finishes, HaveTheColorsComputedByHand) {
  for (int i = 0; i <= static_cast<int>(scenes::Finish::kWhiteMarble); ++i) {
    const scenes::Surface surface = scenes::finished_surface(static_cast<scenes::Finish>(i));
    SCOPED_TRACE(scenes::finish_word(surface.finish));
    scenes::SceneBuilder builder = with_light({0.0, 0.0, 4.0});
    builder.set_surface(surface);
    add_floor(builder, 0.0);
    const scenes::Scene scene = std::move(builder).build();
    const dvec3 color = color_in_the_middle(surface.finish);
    const dvec3 sky = linear(0.2, 0.4, 0.8);
    // The light is directly above, the eye at 45 degrees. The mirror ray and the ray through glass
    // reach the sky.
    const double highlight = std::pow(0.5, 0.5 * std::max(surface.shine, 1.0F));
    const dvec3 expected =
        double{surface.diffuse} * (0.06 + 1.0) * linear(color.x, color.y, color.z) +
        double{surface.specular} * (highlight + sky) + double{surface.transmittance} * sky;
    expect_color(seen(scene, {-5, 0, 5}, {1, 0, -1}), expected);
  }
}

}  // namespace
}  // namespace beambench::render

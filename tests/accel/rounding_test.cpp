// "Rounded once, the same bits for everyone" needs a compiler that rounds.

#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::accel {
namespace {

// Not inlined, so that the two conversions stay adjacent: GCC 12.2 at -O2 and above returns the
// sums unrounded, unless its SLP vectorizer is off (as in our build).
__attribute__((noinline)) glm::dvec2 through_float(const glm::dvec2& a, const glm::dvec2& b) {
  const auto x = static_cast<float>(a.x + b.x);
  const auto y = static_cast<float>(a.y + b.y);
  return {static_cast<double>(x), static_cast<double>(y)};
}

TEST(Rounding, ToFloatAndBackLosesBits) {
  const glm::dvec2 rounded = through_float({1.0 / 3.0, 1.0 / 7.0}, {1.0 / 11.0, 1.0 / 13.0});
  EXPECT_EQ(rounded.x, 0x1.b26c9cp-2);
  EXPECT_EQ(rounded.y, 0x1.c21c22p-3);
}

// The case in which missing rounding did damage: inlined into a structure's loop over pixels, rays
// kept unrounded directions, and 7% of the hits in this scene differed from those of single rays.
TEST(Rounding, ATraceUsesTheExactRaysOfTheCamera) {
  const scenes::Scene scene = scenes::load_scene("escena1");
  const PrimaryRays rays(scene.cameras.front(), 64, 48, 4);
  const auto exhaustive = registry().choose({"exhaustive", {}}).build(scene);
  for (const StructureChoice& choice : registry().choose_list("all")) {
    if (choice.info().name == "tile-beam") continue;  // its images are made without rays
    if (!choice.info().support.includes(scene)) continue;
    const auto structure = choice.build(scene);
    const bool traces_rays = choice.info().support.single_rays;
    const Accelerator& alone = traces_rays ? *structure : *exhaustive;
    HitBuffer image(rays.width(), rays.height(), rays.samples());
    structure->closest_hits(rays, image, {});
    for (int y = 0; y < rays.height(); ++y) {
      for (int x = 0; x < rays.width(); ++x) {
        for (int sample = 0; sample < rays.samples(); ++sample) {
          ASSERT_EQ(image.get(image.index(x, y, sample)),
                    alone.closest_hit(rays.ray(x, y, sample), nullptr))
              << choice.label() << " at pixel " << x << ", " << y << " sample " << sample;
        }
      }
    }
  }
}

}  // namespace
}  // namespace beambench::accel

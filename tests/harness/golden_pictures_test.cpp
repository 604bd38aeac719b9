// Whole pictures: golden ones, and the counts of rays that Haines published.

#include <array>
#include <string>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

#include "scenes/catalogue.hpp"
#include "tests/harness/drawn.hpp"

namespace beambench {
namespace {

RayCensus spd_census(const std::string& name) {
  const Scene scene = load_scene(name);
  const auto structure = built(scene, "sah-bvh");
  const EyeRays rays = corner_rays(scene.cameras.front());
  HitBuffer hits(rays.width, rays.height, 1);
  for (int y = 0; y < rays.height; ++y) {
    for (int x = 0; x < rays.width; ++x) {
      hits.set(hits.index(x, y, 0), structure->closest_hit(rays.ray(x, y, 0)));
    }
  }
  return whitted_picture(Whitted(scene, *structure, {}), rays, hits).census;
}

void expect_within(std::uint64_t found, double published, double share) {
  EXPECT_NEAR(static_cast<double>(found), published, share * published);
}

TEST(Census, OfTetraIsHaines) {
  const RayCensus census = spd_census("tetra:n=6");
  EXPECT_EQ(census.eye, 263'169U);
  EXPECT_EQ(census.reflected, 0U);
  EXPECT_EQ(census.refracted, 0U);
  expect_within(census.eye_hits, 49'788, 0.02);
  expect_within(census.shadow, 46'112, 0.02);
}

TEST(Census, OfTeapotIsHaines) {
  const RayCensus census = spd_census("teapot:n=12");
  EXPECT_EQ(census.eye, 263'169U);
  expect_within(census.eye_hits, 161'120, 0.05);
  expect_within(census.reflected, 225'248, 0.05);
  expect_within(census.shadow, 407'656, 0.05);
}

/// A picture of 64 x 64 pixels, as a PNG keeps it.
OIIO::ImageBuf as_png(const Image& image) {
  OIIO::ImageBuf buffer(OIIO::ImageSpec(image.width(), image.height(), 3, OIIO::TypeDesc::UINT8));
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const glm::vec3 encoded = srgb_from_linear(image.at(x, y));
      const std::array<float, 3> pixel{encoded.x, encoded.y, encoded.z};
      buffer.setpixel(x, y, pixel);
    }
  }
  return buffer;
}

TEST(Whitted, GoldenPictures) {
  for (const std::string name : {"balls:n=2", "mount:n=3", "teapot:n=3", "finishes"}) {
    SCOPED_TRACE(name);
    const Scene scene = load_scene(name);
    const auto structure = built(scene, "sah-bvh");
    const PrimaryRays rays(scene.cameras.front(), 64, 64, 1);
    HitBuffer hits(64, 64, 1);
    structure->trace(rays, hits);
    const OIIO::ImageBuf found =
        as_png(whitted_picture(Whitted(scene, *structure, {}), eye_rays(rays), hits).image);
    const std::string file =
        BEAMBENCH_TEST_FILES "/golden/whitted/" + name.substr(0, name.find(':')) + ".png";
    const OIIO::ImageBuf golden(file);
    ASSERT_TRUE(golden.initialized()) << golden.geterror();
    // Another libm may round pow another way, and a ray along an edge may go the other way.
    const auto difference = OIIO::ImageBufAlgo::compare(found, golden, 3.0F / 255.0F, 0.0F);
    EXPECT_LE(difference.nfail, 40U) << "of 64 x 64 pixels";
    EXPECT_LT(difference.meanerror, 0.002);
  }
}

}  // namespace
}  // namespace beambench

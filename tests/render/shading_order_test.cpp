// The order in which samples are shaded affects the contents of a shadow cache, but not the
// picture.

#include <algorithm>

#include <gtest/gtest.h>

#include "accel/beam/beam_tracer.hpp"
#include "harness/render/whitted_picture.hpp"
#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"
#include "tests/drawn.hpp"

namespace beambench::render {
namespace {

std::vector<std::size_t> sorted(std::vector<std::size_t> places) {
  std::sort(places.begin(), places.end());
  return places;
}

TEST(ShadingOrder, HoldsEverySampleOnce) {
  const scenes::Scene scene = scenes::load_scene("maceta");
  const accel::PrimaryRays rays(scene.cameras.front(), 60, 48, 5);
  const auto beam = built(scene, "beam:max_level=5");
  EXPECT_EQ(sorted(beam_order(*beam, rays)), scan_order(rays));
  EXPECT_NE(beam_order(*beam, rays), scan_order(rays));
}

TEST(ShadingOrder, KeepsTheSamplesOfABeamTogether) {
  // Within a beam the samples are in row order, so a position that precedes its predecessor begins
  // another beam. There are at most as many such positions as beams at occupied leaves, plus one
  // for the remaining samples.
  const scenes::Scene scene = scenes::load_scene("maceta");
  const accel::PrimaryRays rays(scene.cameras.front(), 160, 128, 1);
  const auto beam = built(scene, "beam:max_level=5");
  const std::vector<std::size_t> places = beam_order(*beam, rays);
  std::size_t steps_back = 0;
  for (std::size_t i = 1; i < places.size(); ++i) steps_back += places[i] < places[i - 1] ? 1 : 0;
  std::size_t occupied = 0;
  const auto outlines = beam->inspector()->beams(rays).value();
  for (const accel::BeamOutline& outline : outlines) {
    occupied += outline.kind == accel::BeamKind::kOccupied ? 1 : 0;
  }
  EXPECT_GT(steps_back, 100U);
  EXPECT_LE(steps_back, occupied + 1);
}

TEST(ShadingOrder, ChangesNeitherPictureNorRays) {
  const scenes::Scene scene = scenes::load_scene("maceta");
  const accel::PrimaryRays primary(scene.cameras.front(), 80, 64, 1);
  const accel::PrimaryRays rays = primary;
  const auto beam = built(scene, "beam:max_level=5");
  accel::HitBuffer hits(primary.width(), primary.height(), 1);
  beam->closest_hits(primary, hits, {});
  const Whitted tracer(scene, *beam, {.shadows = ShadowMethod::kCache});
  const WhittedPicture rows = whitted_picture(tracer, rays, hits);
  std::vector<std::uint64_t> cached;
  for (const auto& places : {scan_order(primary), beam_order(*beam, primary)}) {
    const WhittedPicture found = whitted_picture_along(places, tracer, rays, hits);
    for (int y = 0; y < rays.height(); ++y) {
      for (int x = 0; x < rays.width(); ++x) EXPECT_EQ(found.image.at(x, y), rows.image.at(x, y));
    }
    EXPECT_EQ(found.census.eye, rows.census.eye);
    EXPECT_EQ(found.census.shadow, rows.census.shadow);
    EXPECT_EQ(found.census.shadow_hidden, rows.census.shadow_hidden);
    EXPECT_EQ(found.census.reflected, rows.census.reflected);
    cached.push_back(found.census.shadow_cached);
  }
  EXPECT_NE(cached[0], cached[1]);
}

TEST(ShadingOrder, OfBeamsNeedsBeams) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=1");
  const accel::PrimaryRays rays(scene.cameras.front(), 8, 8, 1);
  EXPECT_THROW(beam_order(*built(scene, "samet"), rays), InputError);
}

TEST(ShadingOrder, IsNamed) {
  EXPECT_EQ(parse_shading_order("rows"), ShadingOrder::kRows);
  EXPECT_EQ(parse_shading_order("scan"), ShadingOrder::kScan);
  EXPECT_EQ(parse_shading_order("beams"), ShadingOrder::kBeams);
  EXPECT_THROW(parse_shading_order("columns"), InputError);
}

}  // namespace
}  // namespace beambench::render

// Overlays of tiles and pencils: outlines, mesh, colors, legends; valid requests.

#include "harness/render/picture/place_overlay.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "harness/render/structure_overlay.hpp"
#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::render {
namespace {

using accel::BeamPlace;
using Way = BeamPlace::Way;

const glm::vec3 kBackground(0.2F);

/// Returns two adjacent tiles of 8 x 4 pixels each, in blocks of 4 x 4.
std::vector<BeamPlace> two_tiles() {
  std::vector<BeamPlace> places;
  for (int y = 0; y < 4; ++y) {
    for (std::uint32_t x = 0; x < 16; ++x) places.push_back({Way::kInOrder, 0, x / 8, x / 4});
  }
  return places;
}

std::vector<std::uint32_t> numbers(std::size_t count) {
  std::vector<std::uint32_t> samples(count);
  std::iota(samples.begin(), samples.end(), 0U);
  return samples;
}

std::size_t count_of(const std::vector<LegendEntry>& legend, const std::string& name) {
  const auto found = std::ranges::find(legend, name, &LegendEntry::name);
  EXPECT_NE(found, legend.end()) << name;
  return found == legend.end() ? 0 : found->count;
}

TEST(OverlayTiles, DrawsOutlinesAndAMesh) {
  const std::vector<BeamPlace> places = two_tiles();
  Image image(16, 4, kBackground);
  const auto legend = overlay_tiles(image, {places, numbers(places.size()), 1});
  EXPECT_EQ(count_of(legend, "tiles"), 2U);
  EXPECT_EQ(count_of(legend, "rays in blocks"), 64U);
  EXPECT_EQ(count_of(legend, "passed on to single rays"), 0U);
  EXPECT_EQ(count_of(legend, "background, no rays"), 0U);
  for (int y = 0; y < 4; ++y) {
    EXPECT_EQ(image.at(8, y), okabe_ito::kYellow) << "where a tile begins";
    EXPECT_EQ(image.at(4, y), image.at(12, y)) << "where a block begins";
    EXPECT_EQ(image.at(5, y), image.at(2, y));
    EXPECT_NE(image.at(5, y), image.at(4, y));
    EXPECT_NE(image.at(5, y), okabe_ito::kYellow);
  }
}

TEST(OverlayTiles, EachMethodHasItsColor) {
  std::vector<BeamPlace> places = two_tiles();
  places[2].way = Way::kHandedOver;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].beam == 1) places[i].way = Way::kBackground;
  }
  Image image(16, 4, kBackground);
  const auto legend = overlay_tiles(image, {places, numbers(places.size()), 1});
  EXPECT_EQ(count_of(legend, "rays in blocks"), 31U);
  EXPECT_EQ(count_of(legend, "passed on to single rays"), 1U);
  EXPECT_EQ(count_of(legend, "background, no rays"), 32U);
  EXPECT_EQ(image.at(2, 0), okabe_ito::kVermillion);
  EXPECT_NE(image.at(2, 1), image.at(10, 1));
}

TEST(OverlayPencil, PixelsWithoutARayStayDimmed) {
  const std::vector<BeamPlace> places{{Way::kInOrder, 5, 0, 0},
                                      {Way::kRegrouped, 5, 0, 9},
                                      {Way::kSingle, 0, 0, 0},
                                      {Way::kHandedOver, 4, 0, 1}};
  const std::vector<std::uint32_t> samples{0, 3, 5, 7};
  Image image(4, 2, kBackground);
  const auto legend = overlay_pencil(image, {places, samples, 1});
  EXPECT_EQ(count_of(legend, "parts"), 1U);
  EXPECT_EQ(count_of(legend, "rays in blocks, side -z"), 1U);
  EXPECT_EQ(count_of(legend, "rays in regrouped blocks"), 1U);
  EXPECT_EQ(count_of(legend, "passed on to single rays"), 1U);
  EXPECT_EQ(count_of(legend, "rays traced singly"), 1U);
  EXPECT_EQ(legend.size(), 5U) << "sides that no ray in order passes are not listed";
  for (int i = 0; i < 8; ++i) {
    const bool has_ray = std::ranges::find(samples, static_cast<std::uint32_t>(i)) != samples.end();
    EXPECT_EQ(image.at(i % 4, i / 4) == dimmed(kBackground), !has_ray) << i;
  }
  EXPECT_EQ(image.at(3, 1), okabe_ito::kVermillion);
}

TEST(OverlayPencil, APixelShowsItsFirstSampleThatHasARay) {
  const std::vector<BeamPlace> places{{Way::kHandedOver, 0, 0, 0}, {Way::kRegrouped, 0, 0, 1}};
  const std::vector<std::uint32_t> samples{5, 6};
  Image image(2, 1, kBackground);
  overlay_pencil(image, {places, samples, 4});
  EXPECT_EQ(image.at(0, 0), dimmed(kBackground));
  EXPECT_EQ(image.at(1, 0), okabe_ito::kVermillion);
}

// ---- requests -----------------------------------------------------------------------------------

const accel::StructureInfo& structure(const std::string& name) {
  return accel::registry().choose({name, {}}).info();
}

std::string refusal_of(const std::string& text, const std::string& name) {
  try {
    parse_overlay(text, structure(name));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ParseOverlay, ReadsTheLight) {
  EXPECT_EQ(parse_overlay("pencils", structure("tile-beam")).light, 1U);
  const OverlayChoice choice = parse_overlay("pencils:light=3", structure("tile-beam"));
  EXPECT_EQ(choice.overlay, Overlay::kPencils);
  EXPECT_EQ(choice.light, 3U);
  EXPECT_EQ(parse_overlay("beams", structure("tile-beam")).overlay, Overlay::kBeams);
}

TEST(ParseOverlay, ListsThePossibleValues) {
  EXPECT_NE(refusal_of("pencil", "tile-beam").find("beams, cells, pencils"), std::string::npos);
  EXPECT_NE(refusal_of("pencils", "beam").find("structures that have: tile-beam"),
            std::string::npos);
  EXPECT_NE(refusal_of("beams", "samet").find("structures that have: beam, grid-beam, tile-beam"),
            std::string::npos);
  EXPECT_NE(refusal_of("pencils:light=0", "tile-beam").find("light"), std::string::npos);
  EXPECT_NE(refusal_of("pencils:lamp=1", "tile-beam").find("light"), std::string::npos);
  EXPECT_NE(refusal_of("beams:light=1", "tile-beam").find("light"), std::string::npos);
}

TEST(RequireLight, NamesTheLightsOfTheScene) {
  scenes::Scene scene = scenes::load_scene("teapot:n=2");
  const std::size_t lights = scene.lights.size();
  EXPECT_NO_THROW(require_light({Overlay::kPencils, lights}, scene));
  EXPECT_THROW(require_light({Overlay::kPencils, lights + 1}, scene), InputError);
  EXPECT_NO_THROW(require_light({Overlay::kBeams, lights + 1}, scene));
  scene.lights.clear();
  EXPECT_THROW(require_light({Overlay::kPencils, 1}, scene), InputError);
}

TEST(DrawOverlay, DrawsThePencilOfTheChosenLight) {
  const scenes::Scene scene = scenes::load_scene("teapot:n=4");
  ASSERT_GT(scene.lights.size(), 1U);
  const accel::PrimaryRays rays(scene.cameras.front(), 128, 100, 1);
  const auto accelerator = accel::registry().choose({"tile-beam", {}}).build(scene);
  Image first(128, 100, kBackground);
  Image second = first;
  draw_overlay({Overlay::kPencils, 1}, first, *accelerator, scene, rays);
  const auto legend = draw_overlay({Overlay::kPencils, 2}, second, *accelerator, scene, rays);
  EXPECT_GT(count_of(legend, "parts"), 0U);
  EXPECT_NE(fingerprint(first), fingerprint(second));
}

// A light below a floor that is seen from above.
TEST(DrawOverlay, ALightThatNoHitFacesHasAnEmptyPencil) {
  scenes::SceneBuilder builder("floor");
  const std::vector<glm::dvec3> floor{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  builder.add_polygon(floor);
  builder.add_light({0.0, 0.0, -3.0});
  const scenes::Scene scene = std::move(builder).build();
  const accel::PrimaryRays rays(scene.cameras.front(), 8, 8, 1);
  const auto accelerator = accel::registry().choose({"tile-beam", {}}).build(scene);
  Image image(8, 8, kBackground);
  const auto legend = draw_overlay({Overlay::kPencils, 1}, image, *accelerator, scene, rays);
  EXPECT_EQ(count_of(legend, "parts"), 0U);
  EXPECT_EQ(image.at(3, 3), dimmed(kBackground));
}

}  // namespace
}  // namespace beambench::render

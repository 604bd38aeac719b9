// The beams in which tile-beam reports rays: each ray once, in the beam that traces it.

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "accel/core/beam_place.hpp"
#include "accel/core/inspector_of.hpp"
#include "accel/core/registry.hpp"
#include "harness/rays/ray_generators.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::accel {
namespace {

using Way = BeamPlace::Way;

std::unique_ptr<Accelerator> tile_beam_over(const scenes::Scene& scene) {
  return registry().choose(parse_spec("tile-beam")).build(scene);
}

std::size_t count(const std::vector<BeamPlace>& places, Way way) {
  return static_cast<std::size_t>(std::ranges::count(places, way, &BeamPlace::way));
}

/// Returns the rays of each block, which must lie in the same beam and cross the same side.
std::map<std::uint32_t, std::vector<std::size_t>> blocks_of(const std::vector<BeamPlace>& places) {
  std::map<std::uint32_t, std::vector<std::size_t>> blocks;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].way == Way::kSingle) continue;
    std::vector<std::size_t>& rays = blocks[places[i].block];
    if (!rays.empty()) {
      EXPECT_EQ(places[i].beam, places[rays.front()].beam);
      EXPECT_EQ(places[i].side, places[rays.front()].side);
    }
    rays.push_back(i);
  }
  return blocks;
}

struct TracedImage {
  HitBuffer hits;
  std::map<std::string, std::uint64_t, std::less<>> counters;
  std::vector<BeamPlace> places;
};

TracedImage traced(const scenes::Scene& scene, int width, int height, int samples) {
  const auto structure = tile_beam_over(scene);
  const PrimaryRays rays(scene.cameras.front(), width, height, samples);
  TracedImage image{HitBuffer(width, height, samples), {}, structure->inspector()->places(rays)};
  WorkCounters counters;
  structure->closest_hits(rays, image.hits, {&counters});
  image.counters = counters.by_name();
  return image;
}

TEST(BeamPlaces, EverySampleOfAnImageIsInOneTile) {
  const scenes::Scene scene = scenes::load_scene("teapot:n=4");
  for (const int samples : {1, 4, 5}) {
    const TracedImage image = traced(scene, 301, 203, samples);
    ASSERT_EQ(image.places.size(), image.hits.size());
    EXPECT_EQ(count(image.places, Way::kSingle), 0U);
    EXPECT_EQ(count(image.places, Way::kRegrouped), 0U);
    std::set<std::uint32_t> tiles;
    for (const BeamPlace& place : image.places) tiles.insert(place.beam);
    EXPECT_EQ(tiles.size(), image.counters.at("beams")) << samples;
  }
}

TEST(BeamPlaces, ABlockOfATileIsASquareOfSamples) {
  const TracedImage image = traced(scenes::load_scene("teapot:n=4"), 301, 203, 1);
  for (const auto& [number, rays] : blocks_of(image.places)) {
    EXPECT_LE(rays.size(), 16U);
    const std::size_t first = rays.front();
    for (const std::size_t i : rays) {
      EXPECT_EQ(i % 301 / 4, first % 301 / 4) << number;
      EXPECT_EQ(i / 301 / 4, first / 301 / 4) << number;
    }
  }
}

TEST(BeamPlaces, TheBackgroundOfATileHasNoHits) {
  const TracedImage image = traced(scenes::load_scene("teapot:n=12"), 512, 410, 1);
  EXPECT_GT(count(image.places, Way::kBackground), 0U);
  EXPECT_GT(count(image.places, Way::kInOrder), 0U);
  for (std::size_t i = 0; i < image.places.size(); ++i) {
    if (image.places[i].way == Way::kBackground) {
      EXPECT_FALSE(image.hits.get(i)) << i;
    }
  }
}

// A ray may be handed over at several places of the hierarchy, and is counted at each.
TEST(BeamPlaces, RaysOfAnImageAreHandedOverWhereTheyAreCounted) {
  const TracedImage crowded = traced(scenes::load_scene("bumpy:triangles=12288"), 7, 5, 1);
  EXPECT_GT(count(crowded.places, Way::kHandedOver), 0U);
  EXPECT_LE(count(crowded.places, Way::kHandedOver), crowded.counters.at("handed_over_rays"));
  const TracedImage other = traced(scenes::load_scene("teapot:n=4"), 301, 203, 1);
  EXPECT_EQ(count(other.places, Way::kHandedOver), 0U);
  EXPECT_FALSE(other.counters.contains("handed_over_rays"));
}

TEST(BeamPlaces, AnEmptySceneIsBackground) {
  const scenes::Scene scene = scenes::SceneBuilder("empty").build();
  const auto places =
      tile_beam_over(scene)->inspector()->places(PrimaryRays(scenes::Camera{}, 70, 3, 1));
  EXPECT_EQ(count(places, Way::kBackground), 70U * 3U);
}

// ---- pencils ------------------------------------------------------------------------------------

struct TracedShadows {
  rays::RayList list;
  std::vector<BeamPlace> places;
  std::map<std::string, std::uint64_t, std::less<>> counters;

  /// Returns the pencil of a ray.
  const Pencil& pencil_of(std::size_t i) const {
    return *std::ranges::find_if(list.pencils,
                                 [i](const Pencil& each) { return i < each.first + each.count; });
  }
};

TracedShadows shadows_over(const scenes::Scene& scene, int width = 256, int height = 200) {
  const auto image = std::make_shared<const PrimaryRays>(scene.cameras.front(), width, height, 1);
  TracedShadows traced{
      rays::shadow_rays(scene.lights,
                        rays::in_picture_order(rays::surface_points(scene, *image), *image)),
      {},
      {}};
  traced.list.image = image;
  const auto structure = tile_beam_over(scene);
  traced.places = structure->inspector()->places(traced.list.batch());
  std::vector<std::uint8_t> hits(traced.list.rays.size());
  WorkCounters counters;
  structure->any_hits(traced.list.batch(), hits, {&counters});
  traced.counters = counters.by_name();
  return traced;
}

class PencilPlaces : public ::testing::TestWithParam<const char*> {};

TEST_P(PencilPlaces, EveryShadowRayIsInOneBlockOfItsPencil) {
  const TracedShadows shadows = shadows_over(scenes::load_scene(GetParam()));
  ASSERT_EQ(shadows.places.size(), shadows.list.rays.size());
  EXPECT_EQ(count(shadows.places, Way::kSingle), 0U);
  EXPECT_EQ(count(shadows.places, Way::kBackground), 0U);
  EXPECT_GT(count(shadows.places, Way::kInOrder), 0U);
  EXPECT_GT(count(shadows.places, Way::kRegrouped), 0U);
  std::set<std::pair<std::uint32_t, std::uint8_t>> beams;
  std::map<std::uint32_t, std::size_t> parts;
  std::uint32_t last = 0;
  for (const BeamPlace& place : shadows.places) {
    EXPECT_GE(place.beam, last) << "parts follow each other in the batch";
    last = place.beam;
    beams.emplace(place.beam, place.side);
    ++parts[place.beam];
  }
  EXPECT_EQ(beams.size(), shadows.counters.at("beams"));
  for (const auto& [part, rays] : parts) EXPECT_LE(rays, 256U * 16U) << part;
}

TEST_P(PencilPlaces, TheSideIsTheOneThatTheLineCrosses) {
  const TracedShadows shadows = shadows_over(scenes::load_scene(GetParam()));
  for (std::size_t i = 0; i < shadows.places.size(); ++i) {
    const glm::vec3 from_apex = shadows.list.rays[i].origin - glm::vec3(shadows.pencil_of(i).apex);
    const int axis = shadows.places[i].side / 2;
    const float along = shadows.places[i].side % 2 == 0 ? from_apex[axis] : -from_apex[axis];
    for (int other = 0; other < 3; ++other) EXPECT_GE(along, std::abs(from_apex[other])) << i;
  }
}

TEST_P(PencilPlaces, ABlockInOrderIsASquareOfThePicture) {
  const TracedShadows shadows = shadows_over(scenes::load_scene(GetParam()));
  const auto width = static_cast<std::uint32_t>(shadows.list.image->width());
  std::size_t scattered = 0;
  for (const auto& [number, rays] : blocks_of(shadows.places)) {
    EXPECT_LE(rays.size(), 16U) << number;
    const std::uint32_t first = shadows.list.samples[rays.front()];
    const bool is_square = std::ranges::all_of(rays, [&](std::size_t i) {
      const std::uint32_t sample = shadows.list.samples[i];
      return sample % width / 4 == first % width / 4 && sample / width / 4 == first / width / 4;
    });
    scattered += is_square ? 0 : 1;
    for (const std::size_t i : rays) {
      if (shadows.places[i].way == Way::kInOrder) {
        EXPECT_TRUE(is_square) << number;
      }
    }
  }
  EXPECT_GT(scattered, 0U) << "no block was regrouped";
}

TEST_P(PencilPlaces, RaysAreHandedOverWhereTheyAreCounted) {
  const TracedShadows shadows = shadows_over(scenes::load_scene(GetParam()));
  const std::size_t handed_over = count(shadows.places, Way::kHandedOver);
  const auto counted = shadows.counters.find("handed_over_rays");
  ASSERT_EQ(handed_over > 0, counted != shadows.counters.end());
  if (handed_over > 0) {
    EXPECT_LE(handed_over, counted->second);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, PencilPlaces,
                         ::testing::Values("balls:n=3", "teapot:n=6", "closed-room:detail=3"));

TEST(PencilPlaces, RaysOutsidePencilsAreSingle) {
  const scenes::Scene scene = scenes::load_scene("teapot:n=4");
  TracedShadows shadows = shadows_over(scene, 64, 48);
  const auto structure = tile_beam_over(scene);
  const auto singles = [&] {
    return count(structure->inspector()->places(shadows.list.batch()), Way::kSingle);
  };
  EXPECT_EQ(singles(), 0U);
  for (std::size_t i = 0; i < 5; ++i) shadows.list.rays[100 + i].t_max = 0.25F;
  EXPECT_EQ(singles(), 5U) << "shorter intervals";
  shadows.list.pencils.resize(1);
  const std::size_t others = shadows.list.rays.size() - shadows.list.pencils[0].count;
  EXPECT_EQ(singles(), 5U + others) << "rays that are not marked";
  shadows.list.pencils[0].count = 100;
  EXPECT_EQ(singles(), shadows.list.rays.size()) << "a pencil of few rays";
}

TEST(PencilPlaces, OtherStructuresReportNone) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=2");
  const PrimaryRays rays(scene.cameras.front(), 8, 8, 1);
  const Ray ray = rays.ray(0, 0, 0);
  for (const StructureInfo& info : registry().structures()) {
    const auto structure = registry().choose({info.name, {}}).build(scene);
    const std::size_t expected = info.name == "tile-beam" ? 1 : 0;
    EXPECT_EQ(inspector_of(*structure).places(RayBatch{{&ray, 1}}).size(), expected) << info.name;
    EXPECT_EQ(inspector_of(*structure).places(rays).size(), 64 * expected) << info.name;
  }
}

}  // namespace
}  // namespace beambench::accel

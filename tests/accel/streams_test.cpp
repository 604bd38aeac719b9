// Lists of rays that traverse a hierarchy together, in sah-bvh and tile-beam: the hits of
// exhaustive search for any instruction set, length of the list and number of threads.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "accel/bvh/sah_bvh.hpp"
#include "accel/core/intersect_triangle.hpp"
#include "accel/core/registry.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "accel/tile_beam/tile_beam.hpp"
#include "harness/rays/trace_input.hpp"
#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/only_target.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

using bvh::SahBvh;
using tile_beam::TileBeam;

/// Expects the hits of exhaustive search for a list.
void expect_hits_of_exhaustive(const scenes::Scene& scene, const Accelerator& structure,
                               const std::vector<Ray>& rays) {
  const exhaustive::Exhaustive exhaustive(scene);
  HitBuffer closest(static_cast<int>(rays.size()), 1, 1);
  std::vector<std::uint8_t> any(rays.size(), 7);
  structure.closest_hits(RayBatch{rays}, closest, {});
  structure.any_hits(RayBatch{rays}, any, {});
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto hit = exhaustive.closest_hit(rays[i]);
    ASSERT_EQ(closest.get(i), hit) << "ray " << i;
    ASSERT_EQ(any[i], hit ? 1 : 0) << "ray " << i;
  }
}

/// Returns difficult rays: some end at their own hits, some have lengths that streams cannot trace,
/// and some come from far away.
std::vector<Ray> difficult_rays(const scenes::Scene& scene, std::uint64_t seed, std::size_t count) {
  Random random(seed);
  std::vector<Ray> rays = verify::random_rays(scene, count, random);
  const exhaustive::Exhaustive exhaustive(scene);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto hit = exhaustive.closest_hit(rays[i]);
    if (hit && i % 5 == 0) rays[i].t_max = hit->t;
    if (hit && i % 7 == 0) rays[i].t_min = hit->t;
    if (i % 17 == 0) rays[i].direction *= 0x1p-25F;
    if (i % 19 == 0) rays[i].origin -= 40.0F * rays[i].direction;
    if (i % 23 == 0) std::swap(rays[i].t_min, rays[i].t_max);
    if (!(rays[i].t_min <= kInfinity)) rays[i].t_min = 0.0F;
  }
  return rays;
}

class Streams : public ::testing::TestWithParam<std::int64_t> {
 protected:
  tests::OnlyTarget only_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(All, Streams, ::testing::ValuesIn(hwy::SupportedAndGeneratedTargets()),
                         [](const auto& info) { return hwy::TargetName(info.param); });

TEST_P(Streams, MatchExhaustive) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 10 + 2 * static_cast<int>(seed));
    const auto builder = seed % 3 == 0 ? bvh::BvhBuilder::kSpatial : bvh::BvhBuilder::kBinned;
    const auto collapse = seed % 2 == 0 ? bvh::BvhCollapse::kCost : bvh::BvhCollapse::kArea;
    const SahBvh structure(scene, {{{}, builder, collapse}});
    ASSERT_STREQ(structure.instruction_set(), hwy::TargetName(GetParam()));
    for (const std::size_t count : {bvh::Streams::kLeast, std::size_t{101}, std::size_t{700}}) {
      const std::vector<Ray> rays = difficult_rays(scene, seed + count, count);
      expect_hits_of_exhaustive(scene, structure, rays);
      expect_hits_of_exhaustive(scene, TileBeam(scene, {}), rays);
    }
  }
}

TEST_P(Streams, MatchExhaustiveOnDifficultScenes) {
  for (std::uint64_t seed = 0; seed < 42; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = verify::family_scene(seed);
    const std::vector<Ray> rays = difficult_rays(scene, seed, 400);
    expect_hits_of_exhaustive(scene, SahBvh(scene, {}), rays);
    expect_hits_of_exhaustive(scene, TileBeam(scene, {}), rays);
  }
  for (const auto& [scene, rays] : {verify::cubes_on_a_lattice(), verify::block_of_squares()}) {
    SCOPED_TRACE(scene.name);
    expect_hits_of_exhaustive(scene, SahBvh(scene, {}), rays);
    expect_hits_of_exhaustive(scene, TileBeam(scene, {}), rays);
  }
}

/// Triangles from compact to long and thin, far from the coordinate origin for their size; rays
/// from near and far that are aimed at points inside, near edges and at corners.
struct NeedlesAndRays {
  explicit NeedlesAndRays(std::uint64_t seed) {
    Random random(seed);
    const auto power = [&](double least) { return std::exp2(random.uniform(least, 0.0)); };
    const auto vector = [&](double size) {
      return size * glm::dvec3{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                               random.uniform(-1.0, 1.0)};
    };
    const glm::dvec3 center = vector(std::exp2(random.uniform(0.0, 18.0)));
    scenes::SceneBuilder builder("needles");
    while (builder.primitive_count() < 60) {
      const glm::dvec3 a = center + vector(1.0);
      glm::dvec3 along = vector(power(-8.0));
      glm::dvec3 across = vector(power(-14.0) * glm::length(along));
      const auto flat = static_cast<int>(random.below(4));  // the box has no height
      if (flat < 3) along[flat] = across[flat] = 0.0;
      try {
        builder.add_polygon(std::array{a, a + along, a + across});
      } catch (const InputError&) {  // rounded to a line
      }
    }
    scene = std::move(builder).build();
    for (int i = 0; i < 3000; ++i) {
      const scenes::Triangle& triangle = scene.triangles[random.below(scene.triangles.size())];
      const auto corner = [&](std::size_t k) {
        return glm::dvec3(scene.vertices[triangle.vertex[k]]);
      };
      const double u = random.below(3) == 0 ? power(-30.0) : random.unit();
      const double v = random.below(3) == 0 ? power(-30.0) : random.unit();
      const glm::dvec3 target =
          corner(0) + u * (1.0 - v) * (corner(1) - corner(0)) + u * v * (corner(2) - corner(0));
      Ray& ray = rays.emplace_back();
      ray.origin = glm::vec3(target - vector(power(-22.0)));
      ray.direction =
          glm::vec3((target - glm::dvec3(ray.origin)) * std::exp2(random.uniform(-4.0, 4.0)));
      if (ray.direction == glm::vec3(0.0F)) ray.direction.x = 1.0F;
    }
  }

  scenes::Scene scene;
  std::vector<Ray> rays;
};

// The canonical test must accept every hit that is certain in float.
TEST_P(Streams, MatchExhaustiveOnNeedles) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const NeedlesAndRays needles(seed);
    expect_hits_of_exhaustive(needles.scene, SahBvh(needles.scene, {}), needles.rays);
  }
}

// Long lists, deep hierarchies, rays aimed at vertices and edges of closed meshes.
TEST_P(Streams, LoseNoHitsOnMeshes) {
  for (const char* name : {"bumpy:triangles=3072", "tetra:n=5", "balls:n=2", "rings:n=1"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    const std::vector<Ray> rays = difficult_rays(scene, 3, 3000);
    expect_hits_of_exhaustive(scene, SahBvh(scene, {}), rays);
    expect_hits_of_exhaustive(scene, TileBeam(scene, {}), rays);
  }
}

// A stream without room for more lists continues with packets. A list that is traced in several
// parts has the same hits as single rays.
TEST_P(Streams, TraceListsOfAnyLength) {
  const scenes::Scene scene = scenes::load_scene("bumpy:triangles=3072");
  const SahBvh streams(scene, {});
  bvh::SahBvhOptions options;
  options.streams = false;
  const SahBvh single(scene, options);
  Random random(5);
  const std::vector<Ray> rays = verify::random_rays(scene, 2 * bvh::Stream::kMostRays + 77, random);
  HitBuffer hits(static_cast<int>(rays.size()), 1, 1);
  HitBuffer expected(static_cast<int>(rays.size()), 1, 1);
  std::vector<std::uint8_t> any(rays.size());
  std::vector<std::uint8_t> expected_any(rays.size());
  streams.closest_hits(RayBatch{rays}, hits, {});
  single.closest_hits(RayBatch{rays}, expected, {});
  streams.any_hits(RayBatch{rays}, any, {});
  single.any_hits(RayBatch{rays}, expected_any, {});
  EXPECT_EQ(hits, expected);
  EXPECT_EQ(any, expected_any);
}

void expect_same_on_threads(const scenes::Scene& scene, const Accelerator& structure) {
  Random random(6);
  const std::vector<Ray> rays = verify::random_rays(scene, 3 * bvh::Stream::kMostRays, random);
  const auto trace = [&](int threads) {
    HitBuffer hits(static_cast<int>(rays.size()), 1, 1);
    std::vector<std::uint8_t> any(rays.size());
    WorkCounters counters;
    structure.closest_hits(RayBatch{rays}, hits, {&counters, threads});
    structure.any_hits(RayBatch{rays}, any, {&counters, threads});
    HitBuffer timed(static_cast<int>(rays.size()), 1, 1);
    structure.closest_hits(RayBatch{rays}, timed, {nullptr, threads});
    EXPECT_EQ(timed, hits);
    return std::tuple(hits, any, counters.by_name());
  };
  const auto alone = trace(1);
  EXPECT_EQ(trace(2), alone);
  EXPECT_EQ(trace(5), alone);
}

TEST_P(Streams, AreTheSameOnThreads) {
  const scenes::Scene scene = scenes::load_scene("balls:n=3");
  expect_same_on_threads(scene, SahBvh(scene, {}));
  expect_same_on_threads(scene, TileBeam(scene, {}));
}

// The rays of a batch before, between and after its pencils, including short ranges.
TEST_P(Streams, TraceTheRaysOutsidePencils) {
  const scenes::Scene scene = scenes::load_scene("bumpy:triangles=3072");
  const TileBeam streams(scene, {});
  ASSERT_TRUE(streams.streams());
  const TileBeam single(scene, {.streams = false});
  ASSERT_FALSE(single.streams());
  Random random(8);
  std::vector<Ray> rays = verify::random_rays(scene, 4000, random);
  const glm::vec3 light = 1.5F * scene.bounds.upper;
  std::vector<Pencil> pencils;
  for (const std::size_t first : {std::size_t{20}, std::size_t{1000}, std::size_t{3000}}) {
    pencils.push_back({.first = first, .count = 600, .apex = light, .toward = true});
    for (std::size_t i = first; i < first + 600; ++i) {
      rays[i].direction = light - rays[i].origin;
      rays[i].t_min = 0.0F;
      rays[i].t_max = 1.0F;
    }
  }
  const auto trace = [&](const TileBeam& structure) {
    std::vector<std::uint8_t> any(rays.size());
    WorkCounters counters;
    structure.any_hits(RayBatch{rays, pencils}, any, {&counters});
    return std::pair(any, counters.by_name());
  };
  auto [any, counters] = trace(streams);
  EXPECT_EQ(any, trace(single).first);
  EXPECT_GT(counters["stream_lists"], 2U);
}

// If only images are traced, nothing is built for lists.
TEST(StreamsOfTileBeam, AreBuiltForLists) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=2");
  const auto bytes = [&](const char* lists, bool has_lists) {
    const StructureChoice choice = registry().choose({"tile-beam", {{"lists", lists}}});
    return choice.build(scene, {scene.cameras.front(), 1000, 1, has_lists})->statistics().bytes;
  };
  EXPECT_GT(bytes("streams", false), bytes("single", true));
  EXPECT_EQ(bytes("auto", true), bytes("streams", false));
  EXPECT_EQ(bytes("auto", false), bytes("single", true));
}

/// Returns the diffuse rays of a square image with `side` pixels on each side.
rays::TraceInput diffuse_rays(const scenes::Scene& scene, int side) {
  const rays::ImageOfRays image = rays::image_of(scene.cameras.front(), {{side, side}}, 1);
  return rays::make_trace_input(scene, image, rays::parse_ray_choice("diffuse"));
}

/// The closest hits of a list, and the work of finding them.
struct CountedHits {
  HitBuffer hits;
  WorkCounters work;

  CountedHits(const Accelerator& structure, const rays::TraceInput& input)
      : hits(static_cast<int>(input.size()), 1, 1) {
    structure.closest_hits(input.list()->batch(), hits, {&work});
  }
};

// Nearly all hits can be decided in float.
TEST_P(Streams, NeedTheCanonicalTestForFewHits) {
  const scenes::Scene scene = scenes::load_scene("bumpy:triangles=20000");
  const auto [hits, work] = CountedHits(SahBvh(scene, {}), diffuse_rays(scene, 128));
  std::uint64_t hit = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) hit += hits.get(i) ? 1 : 0;
  EXPECT_LE(work.by_name().at("confirmed_tests"), hit / 5);
  EXPECT_EQ(work.by_name().at("stream_left"), 0U);
}

// Memory left over from an earlier stream does not count as room for the next stream.
TEST(StreamCounters, DoNotDependOnEarlierStreams) {
  const scenes::Scene scene = scenes::load_scene("closed-room:detail=4");
  const SahBvh structure(scene, {});
  const rays::TraceInput few = diffuse_rays(scene, 24);
  std::vector<std::map<std::string, std::uint64_t, std::less<>>> works;
  std::jthread([&] {  // with its own memory
    for (const rays::TraceInput& input : {few, diffuse_rays(scene, 128), few}) {
      works.push_back(CountedHits(structure, input).work.by_name());
    }
  })
      .join();
  EXPECT_EQ(works[0], works[2]);
}

TEST(StreamCounters, ArePinned) {
  if ((hwy::SupportedTargets() & HWY_AVX2) == 0) GTEST_SKIP() << "this machine has no AVX2";
  const tests::OnlyTarget only(HWY_AVX2);
  const scenes::Scene scene = scenes::load_scene("escena1");
  const auto [hits, work] = CountedHits(SahBvh(scene, {}), diffuse_rays(scene, 64));
  std::map<std::string, std::uint64_t> counted;
  for (const auto& [name, count] : work.by_name()) {
    if (count != 0 && std::ranges::count(kTestNames, name) == 0) counted[name] = count;
  }
  const std::map<std::string, std::uint64_t> expected{
      {"box_tests", 33'879},       {"confirmed_tests", 2629}, {"leaves", 4603},
      {"primitive_tests", 35'336}, {"stream_chunks", 603},    {"stream_lists", 9},
      {"stream_rays", 4585},       {"stream_singles", 4},     {"traversal_steps", 9188}};
  EXPECT_EQ(counted, expected);
}

}  // namespace
}  // namespace beambench::accel

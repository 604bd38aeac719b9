// The rasterizer: the hits of exhaustive search for any eye position and field of view.

#include <array>
#include <cstdint>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "harness/verify/selftest/test_scenes.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

/// Work and hits of one image.
struct Traced {
  std::uint64_t tests;
  HitBuffer hits;
};

Traced traced(const char* structure, const scenes::Scene& scene, const PrimaryRays& rays) {
  Traced traced{0, HitBuffer(rays.width(), rays.height(), rays.samples())};
  WorkCounters counters;
  registry().choose({structure, {}}).build(scene)->closest_hits(rays, traced.hits, {&counters});
  traced.tests = counters.get(Counter::kPrimitiveTests);
  return traced;
}

std::size_t hit_count(const HitBuffer& hits) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) count += hits.get(i) ? 1 : 0;
  return count;
}

TEST(ZBuffer, MatchesExhaustiveForCamerasAnywhere) {
  std::size_t hits = 0;
  for (std::uint64_t seed = 1; seed <= 600 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const scenes::Scene scene =
        random.below(2) == 0 ? tests::random_scene(seed, static_cast<int>(1 + random.below(60)))
                             : verify::family_scene(seed);
    scenes::Camera camera = verify::random_camera(scene, random);
    if (random.below(3) == 0) {
      camera.angle = std::array{0.001F, 0.1F, 90.0F, 170.0F, 179.0F, 179.99F}[random.below(6)];
    }
    if (random.below(4) == 0) camera.aspect = std::array{0.02F, 40.0F}[random.below(2)];
    const PrimaryRays rays(camera, 1 + static_cast<int>(random.below(40)),
                           1 + static_cast<int>(random.below(40)),
                           std::array{1, 4, 5}[random.below(3)]);
    const Traced expected = traced("exhaustive", scene, rays);
    const Traced found = traced("z-buffer", scene, rays);
    hits += hit_count(expected.hits);
    ASSERT_EQ(found.hits, expected.hits);
  }
  EXPECT_GT(hits, 100'000U);
}

/// Uses triangles, spheres and cones across the plane of the eye, behind the eye and around it.
TEST(ZBuffer, ClipsPrimitivesBehindTheEye) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    scenes::SceneBuilder builder("around the eye");
    const auto point = [&](double size) { return size * verify::point_in_cube(random); };
    for (int i = 0; i < 12; ++i) {
      const double size = std::array{0.1, 2.0, 100.0}[random.below(3)];
      builder.add_polygon(std::array{point(size), point(size), point(size)});
      builder.add_sphere(point(size), 0.3 * size * random.uniform(0.01, 1.0));
      builder.add_cone(point(size), 0.2 * size, point(size), 0.1 * size * random.uniform(0.0, 1.0));
    }
    const scenes::Scene scene = std::move(builder).build();
    scenes::Camera camera;
    camera.from = glm::vec3(0.0F);
    camera.at = glm::vec3(point(1.0));
    camera.up = {0.0F, 0.0F, 1.0F};
    camera.angle = std::array{20.0F, 90.0F, 160.0F}[random.below(3)];
    const PrimaryRays rays(camera, 33, 21, 1);
    ASSERT_EQ(traced("z-buffer", scene, rays).hits, traced("exhaustive", scene, rays).hits);
  }
}

TEST(ZBuffer, KeepsTheLowestOfEqualPrimitives) {
  const scenes::Scene scene = verify::heap({}).scene;
  const PrimaryRays rays(scene.cameras.front(), 16, 16, 1);
  const Traced found = traced("z-buffer", scene, rays);
  EXPECT_EQ(found.hits, traced("exhaustive", scene, rays).hits);
}

TEST(ZBuffer, TestsLittleMoreThanIsVisible) {
  for (const char* name : {"escena1", "bumpy:triangles=3072", "closed-room"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    const PrimaryRays rays(scene.cameras.front(), 80, 60, 1);
    const Traced found = traced("z-buffer", scene, rays);
    EXPECT_EQ(found.hits, traced("exhaustive", scene, rays).hits);
    // Each sample that hits is tested at least once, and again for each primitive in front.
    EXPECT_GE(found.tests, hit_count(found.hits));
    EXPECT_LE(found.tests, 8 * hit_count(found.hits));
  }
}

TEST(ZBuffer, FindsAnyHitsOfAnImage) {
  const scenes::Scene scene = scenes::load_scene("escena1");
  const PrimaryRays rays(scene.cameras.front(), 31, 22, 5);
  std::vector<std::uint8_t> any(rays.count(), 2);
  registry().choose({"z-buffer", {}}).build(scene)->any_hits(rays, any, {.threads = 3});
  const HitBuffer hits = traced("exhaustive", scene, rays).hits;
  for (std::size_t i = 0; i < any.size(); ++i) ASSERT_EQ(any[i] != 0, hits.get(i).has_value()) << i;
}

}  // namespace
}  // namespace beambench::accel

// Lists of rays in tile-beam, with several rays in flight at once in large hierarchies: results and
// work are the same as for one ray after another.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "accel/bvh/probe_ray.hpp"
#include "accel/core/hit_buffer.hpp"
#include "accel/core/work_counters.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "accel/tile_beam/tile_beam.hpp"
#include "accel/tile_beam/tile_hierarchy.hpp"
#include "accel/tile_beam/tile_kernels.hpp"
#include "scenes/catalogue.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel::tile_beam {
namespace {

constexpr float kUntouched = -7.0F;

/// The results and the counts of a list's kernels for closest-hit and any-hit queries.
struct Answers {
  std::vector<float> t;
  std::vector<scenes::PrimitiveId> primitive;
  std::vector<std::uint8_t> any;
  bool some_left_closest;
  bool some_left_any;
  WorkCounters counters;
};

Answers answers_of(const TileKernels& kernels, const TileHierarchy& hierarchy,
                   const scenes::Scene& scene, std::span<const Ray> rays) {
  Answers answers;
  HitBuffer buffer(static_cast<int>(rays.size()), 1, 1);
  std::fill_n(buffer.t(), rays.size(), kUntouched);
  answers.any.assign(rays.size(), 7);
  answers.some_left_closest = kernels.lists<WorkCounters>().closest_hits(
      hierarchy, scene, rays, buffer, 0, answers.counters);
  answers.some_left_any =
      kernels.lists<WorkCounters>().any_hits(hierarchy, scene, rays, answers.any, answers.counters);
  answers.t.assign(buffer.t(), buffer.t() + rays.size());
  answers.primitive.assign(buffer.primitive(), buffer.primitive() + rays.size());
  return answers;
}

void expect_right(const Answers& answers, const scenes::Scene& scene, std::span<const Ray> rays) {
  const exhaustive::Exhaustive exhaustive(scene);
  bool some_left = false;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    SCOPED_TRACE(i);
    if (!bvh::ProbeRay::can_probe(rays[i])) {
      some_left = true;
      EXPECT_EQ(answers.t[i], kUntouched);
      EXPECT_EQ(answers.any[i], 7);
      continue;
    }
    const auto hit = exhaustive.closest_hit(rays[i], nullptr);
    EXPECT_EQ(answers.t[i], hit ? hit->t : kInfinity);
    EXPECT_EQ(answers.primitive[i], hit ? hit->primitive : scenes::kNoPrimitive);
    EXPECT_EQ(answers.any[i], exhaustive.any_hit(rays[i], nullptr) ? 1 : 0);
  }
  EXPECT_EQ(answers.some_left_closest, some_left);
  EXPECT_EQ(answers.some_left_any, some_left);
}

/// Returns random rays; some directions are too short for the kernels, which skip these rays.
std::vector<Ray> some_rays(const scenes::Scene& scene, std::uint64_t seed, std::size_t count) {
  Random random(seed);
  std::vector<Ray> rays = verify::random_rays(scene, count, random);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if ((i + seed) % 11 == 0) rays[i].direction *= 0x1p-70F;
  }
  return rays;
}

TEST(InterleavedRays, HaveTheHitsOfExhaustiveSearch) {
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 60);
    TileHierarchy hierarchy = build_tile_hierarchy(scene, {});
    if (hierarchy.empty()) continue;
    const std::vector<Ray> rays = some_rays(scene, seed, seed % 40);
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      SCOPED_TRACE(hwy::TargetName(target));
      const TileKernels& kernels = tile_kernels_for(target);
      hierarchy.interleaves_rays = false;
      const Answers one_by_one = answers_of(kernels, hierarchy, scene, rays);
      hierarchy.interleaves_rays = true;
      const Answers interleaved = answers_of(kernels, hierarchy, scene, rays);
      expect_right(one_by_one, scene, rays);
      expect_right(interleaved, scene, rays);
      EXPECT_EQ(interleaved.counters.by_name(), one_by_one.counters.by_name());
    }
  }
}

TEST(InterleavedRays, AreNotForSmallHierarchies) {
  const scenes::Scene scene = scenes::load_scene("soup:triangles=2000");
  EXPECT_FALSE(build_tile_hierarchy(scene, {}).interleaves_rays);
}

/// Traces an image and a pencil with fewer rays than the scene has triangles, so that their rays
/// are handed over to single rays.
TEST(InterleavedRays, ContinueImagesAndPencils) {
  const scenes::Scene large = scenes::load_scene("soup:triangles=250000");
  const TileBeam structure(large, {});
  ASSERT_TRUE(structure.hierarchy().interleaves_rays);

  const PrimaryRays image(large.cameras.front(), 20, 12, 1);
  HitBuffer buffer(20, 12, 1);
  WorkCounters counters;
  structure.closest_hits(image, buffer, {&counters});
  EXPECT_EQ(counters.by_name()["handed_over_rays"], 20U * 12U);
  std::size_t hits = 0;
  image.for_each(0, 12, [&](std::size_t index, const Ray& ray) {
    const auto hit = structure.closest_hit(ray, nullptr);
    // Images store 1/t, which is rounded.
    EXPECT_EQ(buffer.primitive()[index], hit ? hit->primitive : scenes::kNoPrimitive);
    hits += hit ? 1U : 0U;
  });
  EXPECT_GT(hits, 50U);

  Random random(5);
  const glm::vec3 light = large.bounds.upper * 1.5F;
  std::vector<Ray> rays(1000);
  for (Ray& ray : rays) {
    ray.origin = glm::vec3(verify::point_in_cube(random)) * large.bounds.upper;
    ray.direction = light - ray.origin;
    ray.t_max = 1.0F;
  }
  const std::vector<Pencil> pencils{
      {.first = 0, .count = rays.size(), .apex = light, .toward = true}};
  std::vector<std::uint8_t> any(rays.size());
  WorkCounters of_pencil;
  structure.any_hits(accel::RayBatch{rays, pencils, {}, nullptr}, any, {&of_pencil});
  EXPECT_GT(of_pencil.by_name()["handed_over_rays"], 100U);
  std::size_t different = 0;
  std::size_t occluded = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    different += (any[i] == 1) == structure.any_hit(rays[i], nullptr) ? 0U : 1U;
    occluded += any[i];
  }
  EXPECT_LE(different, 1U);  // the other rays of a pencil are tested in float
  EXPECT_GT(occluded, 100U);
  EXPECT_LT(occluded, 900U);
}

}  // namespace
}  // namespace beambench::accel::tile_beam

// Ray classification: no ray loses a primitive, and the division does not depend on the order of
// rays.

#include "accel/ray_classification/ray_classification.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "accel/exhaustive/exhaustive.hpp"
#include "accel/ray_classification/hypercube.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel::ray_classification {
namespace {

Hypercube hypercube(const Interval& along, const Interval& y, const Interval& z,
                    const Interval& slope_y, const Interval& slope_z) {
  return {along, y, z, slope_y, slope_z};
}

TEST(MayMeet, BoundsTheDistancesAtWhichPlacesOverlap) {
  const Face face = Face::of(0);
  const Hypercube straight = hypercube({0, 1}, {0, 1}, {0, 1}, {0, 0}, {0, 0});
  EXPECT_TRUE(may_meet(straight, {face, {{5, 0, 0}, {6, 1, 1}}}));
  EXPECT_TRUE(may_meet(straight, {face, {{5, 1, 1}, {6, 2, 2}}})) << "touches";
  EXPECT_FALSE(may_meet(straight, {face, {{5, 1.01, 0}, {6, 2, 1}}})) << "beside";
  EXPECT_FALSE(may_meet(straight, {face, {{-2, 0, 0}, {-1, 1, 1}}})) << "behind";
  EXPECT_TRUE(may_meet(straight, {face, {{-2, 0, 0}, {0.5, 1, 1}}})) << "around the origins";

  const Hypercube upward = hypercube({0, 0}, {0, 0}, {0, 0}, {0.5, 1}, {0, 0});
  EXPECT_TRUE(may_meet(upward, {face, {{4, 2, 0}, {4, 2, 0}}})) << "slope 0.5";
  EXPECT_TRUE(may_meet(upward, {face, {{4, 4, 0}, {4, 4, 0}}})) << "slope 1";
  EXPECT_FALSE(may_meet(upward, {face, {{4, 1.9, 0}, {4, 1.9, 0}}}));
  EXPECT_FALSE(may_meet(upward, {face, {{4, 4.1, 0}, {4, 5, 0}}}));
}

TEST(MayMeet, SeesABoxFromEachFace) {
  for (std::size_t number = 0; number < kFaces; ++number) {
    const Face face = Face::of(number);
    glm::dvec3 center(0.0);
    center[static_cast<int>(face.along)] = 3.0 * face.sign;
    const Hypercube rays = hypercube({0, 0}, {0, 0}, {0, 0}, {-0.1, 0.1}, {-0.1, 0.1});
    EXPECT_TRUE(may_meet(rays, {face, {center - 0.5, center + 0.5}})) << number;
    EXPECT_FALSE(may_meet(rays, {face, {-center - 0.5, -center + 0.5}})) << number;
  }
}

RC_GTEST_PROP(MayMeet, IsNeverFalseForARayThatMeetsTheBox, ()) {
  Random random(*rc::gen::arbitrary<std::uint64_t>());
  const Face face = Face::of(random.below(kFaces));
  Hypercube rays{};
  Point ray{};
  for (std::size_t i = 0; i < kDimensions; ++i) {
    const double first = random.uniform(-1.0, 1.0);
    const double second = random.uniform(-1.0, 1.0);
    rays[i] = {std::min(first, second), std::max(first, second)};
    ray[i] = random.uniform(rays[i].low, rays[i].high);
  }
  const double s = random.uniform(0.0, 4.0);
  glm::dvec3 point;
  point[static_cast<int>(face.along)] = face.sign * (ray[0] + s);
  for (std::size_t i = 0; i < 2; ++i) {
    point[static_cast<int>(face.aside[i])] = ray[1 + i] + s * ray[3 + i];
  }
  const double half = 1e-9;  // for rounding
  RC_ASSERT(may_meet(rays, {face, {point - half, point + half}}));
}

std::vector<Ray> rays_through(const scenes::Scene& scene, std::size_t count) {
  Random random(7);
  const glm::vec3 extent = scene.bounds.extent();
  const auto place = [&](double wider) {
    return scene.bounds.lower + extent * glm::vec3{random.uniform(-wider, 1.0 + wider),
                                                   random.uniform(-wider, 1.0 + wider),
                                                   random.uniform(-wider, 1.0 + wider)};
  };
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray.origin = place(1.0);
    ray.direction = place(0.0) - ray.origin;
  }
  return rays;
}

TEST(RayClassification, MatchesExhaustiveWithEveryOption) {
  for (const char* name : {"escena2", "misil", "tree:n=4"}) {
    const scenes::Scene scene = scenes::load_scene(name);
    const exhaustive::Exhaustive expected(scene);
    RayTreeOptions never;
    never.max_depth = 0;
    RayTreeOptions deep;
    deep.max_candidates = 1;
    deep.max_depth = 40;
    RayTreeOptions little;
    little.max_references = 200;
    for (const RayTreeOptions& options : {RayTreeOptions{}, never, deep, little}) {
      const RayClassification structure(scene, options);
      for (const Ray& ray : rays_through(scene, 300)) {
        ASSERT_EQ(structure.closest_hit(ray, nullptr), expected.closest_hit(ray, nullptr)) << name;
        ASSERT_EQ(structure.any_hit(ray, nullptr), expected.any_hit(ray, nullptr)) << name;
      }
    }
  }
}

TEST(RayClassification, CountsTheSameInEveryOrderOfRays) {
  const scenes::Scene scene = scenes::load_scene("misil");
  std::vector<Ray> rays = rays_through(scene, 500);
  const auto counted = [&](const std::vector<Ray>& list) {
    const RayClassification structure(scene, {});
    WorkCounters counters;
    for (const Ray& ray : list) structure.closest_hit(ray, &counters);
    return counters.by_name();
  };
  const auto forward = counted(rays);
  std::ranges::reverse(rays);
  EXPECT_EQ(counted(rays), forward);
}

TEST(RayClassification, DividesOnlyWhereRaysArrive) {
  const scenes::Scene scene = scenes::load_scene("misil");
  const RayClassification structure(scene, {});
  EXPECT_EQ(structure.statistics().nodes, kFaces);
  const Ray ray = rays_through(scene, 1).front();
  structure.closest_hit(ray, nullptr);
  const Statistics once = structure.statistics();
  EXPECT_GT(once.nodes, kFaces);
  structure.closest_hit(ray, nullptr);
  EXPECT_EQ(structure.statistics().nodes, once.nodes);
}

TEST(RayClassification, DividesTogetherOnSeveralThreads) {
  const scenes::Scene scene = scenes::load_scene("misil");
  const PrimaryRays image(scene.cameras.front(), 96, 72, 1);
  const RayClassification alone(scene, {});
  HitBuffer expected(96, 72, 1);
  WorkCounters counted;
  alone.closest_hits(image, expected, {&counted});
  for (int round = 0; round < 5; ++round) {
    const RayClassification shared(scene, {});  // nothing is divided when the threads begin
    HitBuffer hits(96, 72, 1);
    WorkCounters counters;
    shared.closest_hits(image, hits, {&counters, 4});
    EXPECT_EQ(counters.by_name(), counted.by_name());
    const std::size_t count = image.count();
    EXPECT_TRUE(std::equal(hits.primitive(), hits.primitive() + count, expected.primitive()));
    EXPECT_TRUE(std::equal(hits.t(), hits.t() + count, expected.t()));
    EXPECT_EQ(shared.statistics().nodes, alone.statistics().nodes);
  }
}

TEST(RayClassification, StopsDividingAtItsLimit) {
  const scenes::Scene scene = scenes::load_scene("misil");
  RayTreeOptions options;
  options.max_references = 1;
  const RayClassification structure(scene, options);
  for (const Ray& ray : rays_through(scene, 100)) structure.closest_hit(ray, nullptr);
  EXPECT_EQ(structure.statistics().nodes, kFaces) << "the roots' lists already exceed the limit";
}

TEST(RayClassification, ShowsTheSetsOnTheRaysPath) {
  const scenes::Scene scene = scenes::load_scene("misil");
  const RayClassification structure(scene, {});
  const Ray ray = rays_through(scene, 1).front();
  const std::vector<TraceStep> steps = structure.path(ray);
  ASSERT_FALSE(steps.empty());
  EXPECT_EQ(steps.front().index, 1U);
  EXPECT_EQ(steps.front().level, 1);
  for (std::size_t i = 1; i < steps.size(); ++i) {
    EXPECT_EQ(steps[i].index / 2, steps[i - 1].index);
    EXPECT_TRUE(steps[i - 1].tests.empty());
    EXPECT_EQ(steps[i - 1].place, "node");
  }
  EXPECT_EQ(steps.back().place, "leaf");
}

}  // namespace
}  // namespace beambench::accel::ray_classification

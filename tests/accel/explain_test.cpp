// A ray's traversal path, step by step: the report matches the actual work.

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "accel/core/inspector_of.hpp"
#include "accel/core/registry.hpp"
#include "accel/octree/samet.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

/// Returns two triangles in opposite corners of [0, 4]^3: eight leaves of size 2, six of them
/// empty.
scenes::Scene triangles_in_two_corners() {
  scenes::SceneBuilder builder("two corners");
  const std::array<glm::dvec3, 3> low{{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}};
  const std::array<glm::dvec3, 3> high{{{3.0, 3.0, 4.0}, {4.0, 3.0, 4.0}, {4.0, 4.0, 4.0}}};
  builder.add_polygon(low);
  builder.add_polygon(high);
  return std::move(builder).build();
}

octree::OctreeOptions eight_cells() {
  octree::OctreeOptions options;
  options.max_level = 2;
  options.pad = 0.0;
  return options;
}

void expect_leaf(const TraceStep& step, std::uint64_t index, const glm::dvec3& lower,
                 double t_enter, double t_exit) {
  EXPECT_EQ(step.place, "leaf");
  EXPECT_EQ(step.index, index);
  EXPECT_EQ(step.level, 2);
  ASSERT_TRUE(step.box);
  constexpr double kPad = 1e-7;  // more than the root's margin for rounding
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(step.box->lower[axis], lower[axis], kPad);
    EXPECT_NEAR(step.box->upper[axis], lower[axis] + 2.0, kPad);
  }
  EXPECT_NEAR(step.t_enter, t_enter, 2.0 * kPad);
  EXPECT_NEAR(step.t_exit, t_exit, 2.0 * kPad);
}

TEST(Explain, SametTraversesASmallOctreeAsByHand) {
  const scenes::Scene scene = triangles_in_two_corners();
  const octree::Samet samet(scene, eight_cells());
  Ray ray;
  ray.origin = {3.25F, 0.25F, 1.5F};
  ray.direction = {-1.0F, 0.0F, -0.5F};

  // The ray leaves the empty leaf at (2, 0, 0) at x = 2 and enters the leaf at the origin. It hits
  // the triangle of this leaf where it leaves the leaf.
  const std::vector<TraceStep> steps = samet.path(ray);
  ASSERT_EQ(steps.size(), 2U);
  expect_leaf(steps[0], 2, {2.0, 0.0, 0.0}, 0.0, 1.25);
  EXPECT_TRUE(steps[0].tests.empty());
  expect_leaf(steps[1], 1, {0.0, 0.0, 0.0}, 1.25, 3.0);
  ASSERT_EQ(steps[1].tests.size(), 1U);
  EXPECT_EQ(steps[1].tests[0].primitive, 0U);
  EXPECT_EQ(steps[1].tests[0].t, 3.0F);
}

TEST(Explain, ATestWithoutAHitIsAMiss) {
  const scenes::Scene scene = triangles_in_two_corners();
  const octree::Samet samet(scene, eight_cells());
  Ray ray;
  ray.origin = {3.25F, 3.75F, 10.0F};  // beside the upper triangle, in its cell

  const std::vector<TraceStep> steps = samet.path(ray);
  ASSERT_EQ(steps.size(), 2U);
  expect_leaf(steps[0], 8, {2.0, 2.0, 2.0}, 6.0, 8.0);
  ASSERT_EQ(steps[0].tests.size(), 1U);
  EXPECT_EQ(steps[0].tests[0].primitive, 1U);
  EXPECT_FALSE(is_hit(steps[0].tests[0].t));
  expect_leaf(steps[1], 4, {2.0, 2.0, 0.0}, 8.0, 10.0);
  EXPECT_TRUE(steps[1].tests.empty());
}

TEST(Explain, ARayThatPassesByEntersNothing) {
  const scenes::Scene scene = triangles_in_two_corners();
  Ray ray;
  ray.origin = {9.0F, 9.0F, 9.0F};
  EXPECT_TRUE(octree::Samet(scene, eight_cells()).path(ray).empty());
}

std::optional<Hit> nearest(const std::vector<TraceStep>& steps) {
  std::optional<Hit> best;
  for (const TraceStep& step : steps) {
    for (const TestedPrimitive& test : step.tests) {
      const Hit hit{test.t, test.primitive};
      if (is_hit(test.t) && (!best || precedes(hit, *best))) best = hit;
    }
  }
  return best;
}

// Holds for every structure that reports steps, including future ones.
TEST(Explain, ReportsTheCountedWorkAndTheHit) {
  int reported = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const scenes::Scene scene = tests::random_scene(seed, 30);
    for (const StructureInfo& info : registry().structures()) {
      if (!info.support.includes(scene)) continue;
      const auto structure = registry().choose(Spec{info.name, {}}).build(scene);
      Random random(seed);
      for (int i = 0; i < 50; ++i) {
        const Ray ray = tests::random_ray(scene, random);
        const std::vector<TraceStep> steps = inspector_of(*structure).path(ray);
        if (steps.empty()) continue;
        ++reported;
        WorkCounters counters;
        ASSERT_EQ(structure->closest_hit(ray, &counters), nearest(steps)) << info.name;
        std::uint64_t tests = 0;
        for (const TraceStep& step : steps) tests += step.tests.size();
        ASSERT_EQ(tests, counters.get(Counter::kPrimitiveTests)) << info.name;
        const auto leaves = std::count_if(
            steps.begin(), steps.end(), [](const TraceStep& step) { return step.place == "leaf"; });
        ASSERT_EQ(static_cast<std::uint64_t>(leaves), counters.get(Counter::kLeaves)) << info.name;
      }
    }
  }
  EXPECT_GT(reported, 1000);
}

TEST(Explain, SametsLeavesFollowEachOther) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const scenes::Scene scene = tests::random_scene(seed, 20);
    const octree::Samet samet(scene, {});
    Random random(seed);
    const std::vector<TraceStep> steps = samet.path(tests::random_ray(scene, random));
    for (std::size_t i = 1; i < steps.size(); ++i) {
      EXPECT_EQ(steps[i].t_enter, std::max(steps[i - 1].t_exit, steps[0].t_enter));
    }
  }
}

}  // namespace
}  // namespace beambench::accel

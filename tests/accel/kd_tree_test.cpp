// The kd-tree: the contents of its leaves, the savings by clipping, and trees computed by hand.

#include "accel/kd_tree/kd_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "accel/bvh/clip.hpp"
#include "accel/core/overlap.hpp"
#include "accel/core/registry.hpp"
#include "accel/core/tolerance.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "accel/kd_tree/kd_tracer.hpp"
#include "accel/kd_tree/split_events.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/accel/built.hpp"
#include "tests/only_target.hpp"
#include "tests/random_scene.hpp"
#include "tests/scenes/thrown_message.hpp"

namespace beambench::accel {
namespace {

using kd_tree::KdTreeOptions;

/// Returns the options of a test, by number: both builders, with and without clipping, deep and
/// shallow.
KdTreeOptions some_kd_options(std::uint64_t number) {
  KdTreeOptions options;
  if (number % 3 == 1) options.builder = KdTreeOptions::Builder::kMedian;
  options.clip = number % 4 != 2;
  options.intersection_cost = number % 2 == 0 ? 4.0 : 0.4;
  options.max_objects = static_cast<std::uint32_t>(number % 5 / 2);
  if (number % 5 == 0) options.max_depth = 9;
  return options;
}

std::vector<scenes::PrimitiveId> primitives_of(const kd_tree::KdTree& tree,
                                               const kd_tree::KdNode& leaf) {
  std::vector<scenes::PrimitiveId> ids;
  for (std::uint32_t i = 0; i < leaf.block_count(); ++i) {
    const bvh::PrimitiveBlock& block = tree.blocks[leaf.first_block() + i];
    ids.insert(ids.end(), block.primitives.begin(), block.primitives.begin() + block.count);
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

double volume(const scenes::Bounds& cell) {
  const glm::dvec3 size = glm::dvec3(cell.upper) - glm::dvec3(cell.lower);
  return size.x * size.y * size.z;
}

// The builder passes down clipped boxes; the definition is a test of the surface against the cell.
TEST(KdTree, LeavesReferToExactlyWhatOverlapsThem) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 25);
    const KdTreeOptions options = some_kd_options(seed);
    const kd_tree::KdTree tree = kd_tree::build_kd_tree(scene, options);
    const double tolerance = overlap_tolerance(scene);
    double sum = 0.0;
    std::uint64_t leaves = 0;
    std::uint64_t references = 0;
    kd_tree::for_each_leaf(tree, [&](const kd_tree::KdNode& leaf, const kd_tree::KdPlace& place) {
      const scenes::Bounds& cell = place.cell;
      sum += volume(cell);
      ++leaves;
      const Box box{glm::dvec3(cell.lower), glm::dvec3(cell.upper)};
      const auto ids = primitives_of(tree, leaf);
      references += ids.size();
      for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
        // The overlap test of cones is conservative, in different ways for a cell and its parts.
        if (scene.primitives[id].kind == scenes::PrimitiveKind::kCone) continue;
        const bool referred = std::binary_search(ids.begin(), ids.end(), id);
        // Planes are one tolerance away from surfaces, where rounding decides.
        EXPECT_TRUE(referred || !surface_overlaps(scene, id, box, 0.999 * tolerance)) << id;
        // References beyond the definition are allowed only within rounding of the boundary.
        if (referred && options.clip) {
          EXPECT_TRUE(surface_overlaps(scene, id, box, 3.0 * tolerance)) << id;
        }
      }
    });
    EXPECT_NEAR(sum / volume(tree.root), 1.0, 1e-9) << "leaves tile the root";
    EXPECT_EQ(leaves, tree.leaves);
    EXPECT_EQ(references, tree.references);
  }
}

TEST(KdTree, EveryInstructionSetMatchesExhaustive) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const tests::OnlyTarget only(target);
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      SCOPED_TRACE(seed);
      const scenes::Scene scene = tests::random_scene(seed, 80);
      const kd_tree::KdTracer structure(scene, some_kd_options(seed));
      ASSERT_STREQ(structure.instruction_set(), hwy::TargetName(target));
      const exhaustive::Exhaustive exhaustive(scene);
      Random random(seed);
      for (int i = 0; i < 200; ++i) {
        const Ray ray = tests::random_ray(scene, random);
        const auto hit = exhaustive.closest_hit(ray, nullptr);
        ASSERT_EQ(structure.closest_hit(ray, nullptr), hit) << "ray " << i;
        ASSERT_EQ(structure.any_hit(ray, nullptr), hit.has_value()) << "ray " << i;
      }
    }
  }
}

// Wald and Havran (2006, section 3.3) report about ten percent.
TEST(KdTree, ClippingLowersTheCost) {
  for (const char* name : {"bumpy:triangles=5000", "teapot:n=4", "escena1"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    KdTreeOptions options;
    options.intersection_cost = 2.0;  // for leaves so small that most primitives are cut
    const kd_tree::KdTree clipped = kd_tree::build_kd_tree(scene, options);
    options.clip = false;
    const kd_tree::KdTree whole = kd_tree::build_kd_tree(scene, options);
    EXPECT_LT(clipped.cost, whole.cost);
  }
}

TEST(KdTree, TheHeuristicCostsLessThanTheMedian) {
  const scenes::Scene scene = scenes::load_scene("teapot:n=4");
  const KdTreeOptions options;
  KdTreeOptions median;
  median.builder = KdTreeOptions::Builder::kMedian;
  EXPECT_LT(kd_tree::build_kd_tree(scene, options).cost,
            kd_tree::build_kd_tree(scene, median).cost);
}

/// Small triangles in opposite corners of the cube [0, 4]^3, `triangles` in each.
scenes::Scene two_corners(int triangles = 1) {
  scenes::SceneBuilder builder("two corners");
  for (int i = 0; i < triangles; ++i) {
    builder.add_polygon(std::array<glm::dvec3, 3>{{{0, 0, 0}, {1, 0, 0}, {0, 1, 1}}});
    builder.add_polygon(std::array<glm::dvec3, 3>{{{4, 4, 4}, {3, 4, 4}, {4, 3, 3}}});
  }
  return std::move(builder).build();
}

Statistics median_statistics(std::uint32_t max_objects, int max_depth) {
  const scenes::Scene scene = two_corners();
  KdTreeOptions options;
  options.builder = KdTreeOptions::Builder::kMedian;
  options.max_objects = max_objects;
  options.max_depth = max_depth;
  return kd_tree::KdTracer(scene, options).statistics();
}

TEST(KdTree, TheMedianSplitsLikeKaplan) {
  // Across x, once: each half has one triangle.
  const Statistics one = median_statistics(1, 10);
  EXPECT_EQ(one.nodes, 3U);
  EXPECT_EQ(one.leaves, 2U);
  EXPECT_EQ(one.empty_leaves, 0U);
  EXPECT_EQ(one.references, 2U);
  EXPECT_EQ(one.depth, 2U);

  // Across x, y and z: the splits across y and z each cut off an empty half, on both sides.
  const Statistics three = median_statistics(0, 3);
  EXPECT_EQ(three.nodes, 11U);
  EXPECT_EQ(three.leaves, 6U);
  EXPECT_EQ(three.empty_leaves, 4U);
  EXPECT_EQ(three.references, 2U);
  EXPECT_EQ(three.depth, 4U);

  const Statistics none = median_statistics(0, 0);
  EXPECT_EQ(none.nodes, 1U);
  EXPECT_EQ(none.references, 2U);
  EXPECT_EQ(none.depth, 1U);
}

TEST(KdTree, TheHeuristicCutsEmptySpaceOff) {
  const scenes::Scene scene = two_corners(16);
  KdTreeOptions options;
  options.intersection_cost = 10.0;
  const kd_tree::KdTracer structure(scene, options);
  const Statistics statistics = structure.statistics();
  EXPECT_GT(statistics.empty_leaves, 0U);
  double occupied = 0.0;
  for (const auto& [cell, level] : structure.occupied_cells()) {
    EXPECT_GT(level, 1);
    const glm::dvec3 size = cell.upper - cell.lower;
    occupied += size.x * size.y * size.z;
  }
  EXPECT_LT(occupied, 2.0 * 1.001) << "the boxes of the triangles are unit cubes";
}

TEST(KdTree, MaxDepthLimitsTheSplits) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=5");
  for (const int depth : {0, 1, 5, 12}) {
    KdTreeOptions options;
    options.max_depth = depth;
    EXPECT_LE(kd_tree::build_kd_tree(scene, options).depth, static_cast<std::uint32_t>(depth) + 1);
  }
  EXPECT_EQ(KdTreeOptions().depth_for(1), 8);
  EXPECT_EQ(KdTreeOptions().depth_for(1U << 20U), 34);
}

TEST(KdTree, MaxObjectsIsTheLargestNodeThatIsNotSplit) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=4");
  KdTreeOptions options;
  options.max_objects = static_cast<std::uint32_t>(scene.triangles.size());
  EXPECT_EQ(kd_tree::build_kd_tree(scene, options).leaves, 1U);
}

TEST(KdTree, CapOnReferencesIsAClearError) {
  const scenes::Scene scene = scenes::load_scene("escena1");
  EXPECT_TRUE(scenes::says(tests::refusal("kd-tree:max_references=100", scene),
                           {"kd-tree", "430 primitives", "more than 100 references", "max_depth",
                            "max_objects", "max_references"}));
}

TEST(KdTree, CapOnReferencesFollowsThePrimitives) {
  EXPECT_EQ(KdTreeOptions().references_for(100), 10'000'000U);
  EXPECT_EQ(KdTreeOptions().references_for(5'000'000), 40'000'000U);
  KdTreeOptions given;
  given.max_references = 5;
  EXPECT_EQ(given.references_for(5'000'000), 5U);
}

TEST(KdTree, RefusesParametersOutOfRange) {
  for (const char* spec : {"kd-tree:traversal_cost=0", "kd-tree:empty_bonus=1.5",
                           "kd-tree:max_depth=65", "kd-tree:builder=mean"}) {
    EXPECT_THROW(registry().choose(parse_spec(spec)), InputError) << spec;
  }
}

TEST(KdTree, ExplainsLeavesThatFollowEachOther) {
  int compared = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const scenes::Scene scene = tests::random_scene(seed, 20);
    const kd_tree::KdTracer structure(scene, some_kd_options(seed));
    Random random(seed);
    const Ray ray = tests::random_ray(scene, random);
    std::optional<TraceStep> before;
    for (const TraceStep& step : structure.path(ray)) {
      ASSERT_TRUE(step.box);
      if (step.place != "leaf") continue;
      const double middle = 0.5 * (step.t_enter + step.t_exit);
      for (int axis = 0; axis < 3; ++axis) {
        const double at = ray.origin[axis] + middle * ray.direction[axis];
        EXPECT_GE(at, step.box->lower[axis] - 1e-6 * (1.0 + std::abs(at)));
        EXPECT_LE(at, step.box->upper[axis] + 1e-6 * (1.0 + std::abs(at)));
      }
      if (before) {
        EXPECT_EQ(step.t_enter, std::max(before->t_exit, double{ray.t_min}));
        ++compared;
      }
      before = step;
    }
  }
  EXPECT_GT(compared, 40);
}

void expect_box(const std::optional<Box>& box, const glm::dvec3& lower, const glm::dvec3& upper) {
  ASSERT_TRUE(box);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(box->lower[axis], lower[axis], 1e-6);
    EXPECT_NEAR(box->upper[axis], upper[axis], 1e-6);
  }
}

TEST(KdTreeClip, KeepsThePartOfATriangle) {
  scenes::SceneBuilder builder("triangle");
  builder.add_polygon(std::array<glm::dvec3, 3>{{{0, 0, 0}, {4, 0, 0}, {0, 4, 4}}});
  const scenes::Scene scene = std::move(builder).build();
  const bvh::PrimitivePart piece{0, 0};
  expect_box(bvh::clipped_bounds(scene, piece, {{-1, -1, -1}, {5, 5, 5}}), {0, 0, 0}, {4, 4, 4});
  expect_box(bvh::clipped_bounds(scene, piece, {{1, -1, -1}, {2, 5, 5}}), {1, 0, 0}, {2, 3, 3});
  expect_box(bvh::clipped_bounds(scene, piece, {{2, 1, -1}, {5, 5, 5}}), {2, 1, 1}, {3, 2, 2});
  EXPECT_FALSE(bvh::clipped_bounds(scene, piece, {{3, 3, 0}, {4, 4, 4}}))
      << "only its box overlaps";
  expect_box(bvh::whole_bounds(scene, piece, {{3, 3, 0}, {4, 4, 4}}), {3, 3, 0}, {4, 4, 4});
}

TEST(KdTreeClip, KeepsThePartOfASphere) {
  scenes::SceneBuilder builder("sphere");
  builder.add_sphere(glm::dvec3(0.0), 1.0);
  const scenes::Scene scene = std::move(builder).build();
  const bvh::PrimitivePart piece{0, 0};
  expect_box(bvh::clipped_bounds(scene, piece, {{0.6, -2, -2}, {2, 2, 2}}), {0.6, -0.8, -0.8},
             {1, 0.8, 0.8});
  EXPECT_FALSE(bvh::clipped_bounds(scene, piece, {{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}}))
      << "a sphere is hollow";
  EXPECT_FALSE(bvh::clipped_bounds(scene, piece, {{0.8, 0.8, 0.8}, {2, 2, 2}}));
}

TEST(KdTreeEvents, AreSortedByPlaneThenKindThenItem) {
  Random random(7);
  std::vector<kd_tree::SplitEvent> events;
  for (std::uint32_t item = 0; item < 3000; ++item) {
    const auto lower = static_cast<float>(std::round(random.uniform(-50.0, 50.0)) / 8.0);
    events.push_back(kd_tree::SplitEvent::begin(lower, item));
    events.push_back(kd_tree::SplitEvent::end(lower + 0.25F, item));
    EXPECT_EQ(events[2 * item].plane().plane(), lower);
    EXPECT_EQ(events[2 * item].item(), item);
    EXPECT_TRUE(events[2 * item].is_begin());
    EXPECT_FALSE(events[2 * item + 1].is_begin());
  }
  std::vector<kd_tree::SplitEvent> scratch(events.size());
  kd_tree::sort_events(events, scratch);
  EXPECT_TRUE(std::is_sorted(events.begin(), events.end()));
  for (std::size_t i = 1; i < events.size(); ++i) {
    EXPECT_LE(events[i - 1].plane().plane(), events[i].plane().plane());
  }
}

}  // namespace
}  // namespace beambench::accel

// Goldsmith and Salmon's hierarchy: its invariants, its cost, and the work of building it.

#include "accel/bvh/goldsmith_salmon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/accel/contains.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

using Order = bvh::GoldsmithSalmonOptions::Order;

bvh::GoldsmithSalmonOptions options_for(Order order,
                                        bvh::Insertion insertion = bvh::Insertion::kEverywhere) {
  bvh::GoldsmithSalmonOptions options;
  options.order = order;
  options.insertion = insertion;
  return options;
}

constexpr std::array kInsertions{bvh::Insertion::kEverywhere, bvh::Insertion::kTerminal};

/// Expects every primitive once and within its box, every box to be the union of its children's
/// boxes, and volumes to have at least two children (the root may have one).
void expect_valid(const bvh::InsertionHierarchy& hierarchy, const scenes::Scene& scene) {
  const auto& entries = hierarchy.entries;
  std::vector<int> seen(scene.primitives.size(), 0);
  std::uint64_t volumes = 0;
  for (std::uint32_t i = 0; i < entries.size(); ++i) {
    ASSERT_GT(entries[i].end, i);
    ASSERT_LE(entries[i].end, entries.size());
    if (!entries[i].is_volume()) {
      ASSERT_EQ(entries[i].end, i + 1);
      ++seen[entries[i].primitive];
      EXPECT_TRUE(
          tests::contains(entries[i].box, scenes::primitive_bounds(scene, entries[i].primitive)));
      continue;
    }
    ++volumes;
    scenes::Bounds below;
    std::uint64_t children = 0;
    for (std::uint32_t child = i + 1; child < entries[i].end; child = entries[child].end) {
      ASSERT_LE(entries[child].end, entries[i].end) << "a child reaches beyond its parent";
      below.include(entries[child].box);
      ++children;
    }
    EXPECT_GE(children, i == 0 ? 1U : 2U);
    EXPECT_LE(children, hierarchy.widest);
    EXPECT_EQ(below.lower, entries[i].box.lower);
    EXPECT_EQ(below.upper, entries[i].box.upper);
  }
  EXPECT_EQ(volumes, hierarchy.volumes);
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1),
            static_cast<std::ptrdiff_t>(scene.primitives.size()));
}

TEST(GoldsmithSalmon, HoldsEveryPrimitiveOnceInBoxesThatFit) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, static_cast<int>(1 + seed * 3));
    for (const Order order : {Order::kGiven, Order::kShuffled, Order::kSorted}) {
      for (const bvh::Insertion insertion : kInsertions) {
        expect_valid(bvh::GoldsmithSalmon(scene, options_for(order, insertion)).hierarchy(), scene);
      }
    }
  }
  for (const char* name : {"balls:n=3", "tetra:n=4", "bumpy:triangles=3072"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    for (const bvh::Insertion insertion : kInsertions) {
      expect_valid(bvh::GoldsmithSalmon(scene, options_for(Order::kGiven, insertion)).hierarchy(),
                   scene);
    }
  }
}

scenes::Bounds cube(float low, float high) { return {glm::vec3(low), glm::vec3(high)}; }

bvh::InsertionHierarchy insert_in_order(const std::vector<scenes::Bounds>& boxes,
                                        bvh::Insertion insertion = bvh::Insertion::kEverywhere) {
  std::vector<scenes::PrimitiveId> order(boxes.size());
  for (scenes::PrimitiveId id = 0; id < order.size(); ++id) order[id] = id;
  return bvh::build_by_insertion(boxes, order, insertion);
}

// Costs are half areas; that of a cube of side s is 3 s^2.
TEST(GoldsmithSalmon, ChoosesAsByHand) {
  // Two cubes of side 1 at either end of a cube of side 10; the third lies beside the first. Adding
  // it to the root costs 300; pairing it with the first cube costs 2 x 12 = 24.
  const bvh::InsertionHierarchy paired = insert_in_order({cube(0, 1), cube(9, 10), cube(1, 2)});
  EXPECT_EQ(paired.volumes, 2U);
  EXPECT_DOUBLE_EQ(paired.cost, 2.0 + 2.0 * 12.0 / 300.0);

  // The fourth cube lies within the pair. Adding it to the pair costs 12; pairing it with one of
  // the pair's cubes of side 1, which it overlaps by half, costs 13.5.
  const bvh::InsertionHierarchy wider =
      insert_in_order({cube(0, 1), cube(9, 10), cube(1, 2), cube(0.5F, 1.5F)});
  EXPECT_EQ(wider.volumes, 2U);
  EXPECT_EQ(wider.widest, 3U);
  EXPECT_DOUBLE_EQ(wider.cost, 2.0 + 3.0 * 12.0 / 300.0);

  // Three coincident cubes share a volume. Enlarging it for a fourth cube, far away, would cost
  // 3 x 297 for these three alone; a new root above both costs less.
  const bvh::InsertionHierarchy above =
      insert_in_order({cube(0, 1), cube(0, 1), cube(0, 1), cube(9, 10)});
  EXPECT_EQ(above.volumes, 2U);
  EXPECT_EQ(above.depth, 2U);
  EXPECT_DOUBLE_EQ(above.cost, 2.0 + 3.0 * 3.0 / 300.0);
}

TEST(GoldsmithSalmon, ChoosesBesideTheTerminalNodeByHand) {
  // The third cube's path ends at the first cube. Adding it to the root costs 300; a pair costs 24.
  const bvh::InsertionHierarchy paired =
      insert_in_order({cube(0, 1), cube(9, 10), cube(1, 2)}, bvh::Insertion::kTerminal);
  EXPECT_EQ(paired.volumes, 2U);
  EXPECT_DOUBLE_EQ(paired.cost, 2.0 + 2.0 * 12.0 / 300.0);

  // The fourth cube's path ends at one of the pair's cubes. Adding it beside that cube costs 12;
  // pairing it with that cube costs 2 x 6.75.
  const bvh::InsertionHierarchy wider = insert_in_order(
      {cube(0, 1), cube(9, 10), cube(1, 2), cube(0.5F, 1.5F)}, bvh::Insertion::kTerminal);
  EXPECT_EQ(wider.volumes, 2U);
  EXPECT_EQ(wider.widest, 3U);
  EXPECT_DOUBLE_EQ(wider.cost, 2.0 + 3.0 * 12.0 / 300.0);

  // No volume is inserted above a volume that the path has passed: the far cube enlarges the only
  // volume and stays in it.
  const bvh::InsertionHierarchy below =
      insert_in_order({cube(0, 1), cube(0, 1), cube(0, 1), cube(9, 10)}, bvh::Insertion::kTerminal);
  EXPECT_EQ(below.volumes, 1U);
  EXPECT_DOUBLE_EQ(below.cost, 4.0);

  // A path follows the least growth, into a volume or to an object: the fourth cube's path leads
  // into the pair at 0, the fifth cube's to the cube at 9, with which it forms a pair in the root.
  const bvh::InsertionHierarchy two =
      insert_in_order({cube(0, 1), cube(9, 10), cube(1, 2), cube(0.5F, 1.5F), cube(8.5F, 9.5F)},
                      bvh::Insertion::kTerminal);
  EXPECT_EQ(two.volumes, 3U);
  EXPECT_DOUBLE_EQ(two.cost, 2.0 + 3.0 * 12.0 / 300.0 + 2.0 * 6.75 / 300.0);
}

// The thesis prints: bola-espacial 1,154 boxes, cost 372; tetera 731 and 130; escena1 cost 4.64
// (section 5.4.2).
TEST(GoldsmithSalmon, HasPinnedSizesInScenesOfTheThesis) {
  struct Sizes {
    const char* scene;
    bvh::Insertion insertion;
    std::uint64_t boxes;
    double cost;
  };
  for (const Sizes& expected : {Sizes{"tetera", bvh::Insertion::kEverywhere, 449, 25.749},
                                Sizes{"tetera", bvh::Insertion::kTerminal, 385, 70.362},
                                Sizes{"bola-espacial", bvh::Insertion::kEverywhere, 867, 57.973},
                                Sizes{"bola-espacial", bvh::Insertion::kTerminal, 825, 88.561},
                                Sizes{"escena1", bvh::Insertion::kEverywhere, 296, 56.212},
                                Sizes{"escena1", bvh::Insertion::kTerminal, 293, 59.849}}) {
    SCOPED_TRACE(expected.scene);
    const scenes::Scene scene = scenes::load_scene(expected.scene);
    const bvh::GoldsmithSalmon structure(scene, options_for(Order::kGiven, expected.insertion));
    EXPECT_EQ(structure.hierarchy().volumes, expected.boxes);
    EXPECT_NEAR(structure.hierarchy().cost, expected.cost, 0.001);
  }
}

TEST(GoldsmithSalmon, StatisticsReportSizeAndCost) {
  const scenes::Scene scene = scenes::load_scene("escena1");
  const bvh::GoldsmithSalmon structure(scene, {});
  const Statistics statistics = structure.statistics();
  EXPECT_EQ(statistics.references, 430U);
  EXPECT_EQ(statistics.nodes, structure.hierarchy().volumes);
  ASSERT_FALSE(statistics.more.empty());
  EXPECT_EQ(statistics.more.front().first, "cost");
  EXPECT_EQ(statistics.more.front().second, structure.hierarchy().cost);
}

TEST(GoldsmithSalmon, OrderAffectsTheTreeButNotTheHits) {
  const scenes::Scene scene = scenes::load_scene("bumpy:triangles=3072");
  const exhaustive::Exhaustive exhaustive(scene);
  Random random(5);
  for (const bvh::Insertion insertion : kInsertions) {
    std::vector<double> costs;
    for (const Order order : {Order::kGiven, Order::kShuffled, Order::kSorted}) {
      const bvh::GoldsmithSalmon structure(scene, options_for(order, insertion));
      costs.push_back(structure.hierarchy().cost);
      for (int i = 0; i < 300; ++i) {
        const Ray ray = tests::random_ray(scene, random);
        EXPECT_EQ(structure.closest_hit(ray, nullptr), exhaustive.closest_hit(ray, nullptr));
        EXPECT_EQ(structure.any_hit(ray, nullptr), exhaustive.any_hit(ray, nullptr));
      }
    }
    EXPECT_LT(costs[1], costs[0])
        << "a mesh inserted in its own order makes a worse tree than in random order";
    EXPECT_NE(costs[0], costs[2]);
    bvh::GoldsmithSalmonOptions other_seed = options_for(Order::kShuffled, insertion);
    other_seed.seed = 2;
    EXPECT_NE(bvh::GoldsmithSalmon(scene, other_seed).hierarchy().cost, costs[1]);
  }
}

TEST(GoldsmithSalmon, BothInsertionsMatchExhaustive) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, static_cast<int>(1 + seed * 3));
    const exhaustive::Exhaustive exhaustive(scene);
    for (const bvh::Insertion insertion : kInsertions) {
      const bvh::GoldsmithSalmon structure(scene, options_for(Order::kGiven, insertion));
      Random random(seed);
      for (int i = 0; i < 100; ++i) {
        const Ray ray = tests::random_ray(scene, random);
        ASSERT_EQ(structure.closest_hit(ray, nullptr), exhaustive.closest_hit(ray, nullptr));
        ASSERT_EQ(structure.any_hit(ray, nullptr), exhaustive.any_hit(ray, nullptr));
      }
    }
  }
}

// The queue visits the nearest of all waiting boxes first, and the stack the nearest child first,
// so the queue never enters more boxes.
TEST(GoldsmithSalmon, TheQueueEntersNoMoreThanTheStack) {
  for (const char* name : {"balls:n=3", "tetra:n=5", "escena1"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    bvh::GoldsmithSalmonOptions stack;
    stack.queue = bvh::GoldsmithSalmonOptions::Queue::kStack;
    std::array<HitBuffer, 2> hits{HitBuffer(64, 64, 1), HitBuffer(64, 64, 1)};
    std::array<WorkCounters, 2> work;
    const PrimaryRays rays(scene.cameras.front(), 64, 64, 1);
    bvh::GoldsmithSalmon(scene, {}).closest_hits(rays, hits[0], {&work[0]});
    bvh::GoldsmithSalmon(scene, stack).closest_hits(rays, hits[1], {&work[1]});
    EXPECT_EQ(hits[0], hits[1]);
    EXPECT_LE(work[0].get(Counter::kTraversalSteps), work[1].get(Counter::kTraversalSteps));
    EXPECT_LE(work[0].get(Counter::kBoxTests), work[1].get(Counter::kBoxTests));
  }
}

/// Returns the number of boxes weighed per primitive.
double work_per_primitive(const scenes::Scene& scene, const bvh::GoldsmithSalmonOptions& options) {
  const bvh::GoldsmithSalmon structure(scene, options);
  return static_cast<double>(structure.hierarchy().boxes_weighed) /
         static_cast<double>(scene.primitives.size());
}

TEST(GoldsmithSalmon, BuildingIsFarFromQuadratic) {
  const scenes::Scene small_scene = scenes::load_scene("bumpy:triangles=4000");
  const scenes::Scene large_scene = scenes::load_scene("bumpy:triangles=64000");
  // The large scene has 16 times as many primitives. When this was written, the work per primitive
  // grew by a factor of at most 2.0 with kEverywhere, and at most 3.6 with kTerminal.
  for (const auto& [insertion, growth] :
       {std::pair(bvh::Insertion::kEverywhere, 3.0), std::pair(bvh::Insertion::kTerminal, 4.5)}) {
    for (const Order order : {Order::kGiven, Order::kShuffled, Order::kSorted}) {
      const double small = work_per_primitive(small_scene, options_for(order, insertion));
      const double large = work_per_primitive(large_scene, options_for(order, insertion));
      EXPECT_LT(large, growth * small)
          << "exponent " << 1.0 + std::log(large / small) / std::log(16.0);
    }
  }
}

TEST(GoldsmithSalmon, ManyObjectsInOnePlaceAreBuiltInLinearTime) {
  for (const double jitter : {0.0, 1e-6, 0.05}) {
    scenes::SceneBuilder builder("heap");
    Random random(1);
    for (int i = 0; i < 10'000; ++i) {
      builder.add_sphere(
          {random.uniform(0, jitter), random.uniform(0, jitter), random.uniform(0, jitter)}, 0.5);
    }
    EXPECT_LT(work_per_primitive(std::move(builder).build(), options_for(Order::kGiven)), 3.0)
        << jitter;
  }
}

// Each sphere is larger than all before: volumes above volumes, as deep as possible.
TEST(GoldsmithSalmon, SupportsADeepHierarchy) {
  scenes::SceneBuilder builder("shells");
  for (int i = 0; i < 150; ++i) builder.add_sphere({0.0, 0.0, 0.0}, 1e-12 * std::pow(1.35, i));
  const scenes::Scene scene = std::move(builder).build();
  const bvh::GoldsmithSalmon structure(scene, {});
  EXPECT_GT(structure.hierarchy().depth, 30U);
  const exhaustive::Exhaustive exhaustive(scene);
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Ray ray = tests::random_ray(scene, random);
    EXPECT_EQ(structure.closest_hit(ray, nullptr), exhaustive.closest_hit(ray, nullptr));
    EXPECT_EQ(structure.any_hit(ray, nullptr), exhaustive.any_hit(ray, nullptr));
  }
}

}  // namespace
}  // namespace beambench::accel

// The traversals of the octree from the root find the same leaves as Samet's.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "accel/core/work_counters.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "accel/octree/from_root.hpp"
#include "accel/octree/samet.hpp"
#include "scenes/base/random.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

octree::OctreeOptions some_octree_options(std::uint64_t number) {
  octree::OctreeOptions options;
  options.max_level = static_cast<int>(1 + number % 6);
  options.max_objects = static_cast<std::uint32_t>(number % 3);
  if (number % 4 == 1) options.root = octree::OctreeOptions::Root::kBox;
  if (number % 5 == 2) options.assign = octree::OctreeOptions::Assign::kBounds;
  return options;
}

/// Counts the nodes from the root to each leaf of a path, including the leaves.
std::uint64_t levels_of(const std::vector<TraceStep>& path) {
  std::uint64_t levels = 0;
  for (const TraceStep& step : path) levels += static_cast<std::uint64_t>(step.level);
  return levels;
}

TEST(TopDownOctree, LeavesTheirOrderAndTestsMatchSamet) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 25);
    const octree::Samet samet(scene, some_octree_options(seed));
    const octree::Glassner glassner(scene, some_octree_options(seed));
    const octree::Gargantini gargantini(scene, some_octree_options(seed));
    const octree::GlassnerHashed glassner_hashed(scene, some_octree_options(seed));
    const octree::GargantiniHashed gargantini_hashed(scene, some_octree_options(seed));
    const octree::GlassnerIterative iterative(scene, some_octree_options(seed));
    const octree::GlassnerIterativeOnDemand iterative_on_demand(scene, some_octree_options(seed));
    const octree::GlassnerIterativeHashed iterative_hashed(scene, some_octree_options(seed));
    const exhaustive::Exhaustive exhaustive(scene);
    Random random(seed);
    for (int i = 0; i < 100; ++i) {
      const Ray ray = tests::random_ray(scene, random);
      const auto expected = samet.path(ray);
      const auto hit = exhaustive.closest_hit(ray, nullptr);
      // Leaves built on demand are numbered differently.
      ASSERT_EQ(iterative_on_demand.path(ray).size(), expected.size());
      ASSERT_EQ(iterative_on_demand.closest_hit(ray, nullptr), hit);
      for (const Accelerator* structure : {static_cast<const Accelerator*>(&glassner),
                                           static_cast<const Accelerator*>(&gargantini),
                                           static_cast<const Accelerator*>(&glassner_hashed),
                                           static_cast<const Accelerator*>(&gargantini_hashed),
                                           static_cast<const Accelerator*>(&iterative),
                                           static_cast<const Accelerator*>(&iterative_hashed)}) {
        const auto actual = structure->inspector()->path(ray);
        ASSERT_EQ(actual.size(), expected.size());
        for (std::size_t step = 0; step < actual.size(); ++step) {
          ASSERT_EQ(actual[step].index, expected[step].index);
          ASSERT_EQ(actual[step].level, expected[step].level);
          ASSERT_EQ(actual[step].t_enter, expected[step].t_enter);
          ASSERT_EQ(actual[step].t_exit, expected[step].t_exit);
          ASSERT_EQ(actual[step].tests.size(), expected[step].tests.size());
        }
        ASSERT_EQ(structure->closest_hit(ray, nullptr), hit);
        ASSERT_EQ(structure->any_hit(ray, nullptr), hit.has_value());
      }
    }
  }
}

// A search from the root passes a node on each level; the descent in order passes each node once.
TEST(TopDownOctree, StepsAreTheNodesPassed) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 40);
    octree::OctreeOptions options = some_octree_options(seed);
    options.max_level = 6;
    const octree::Glassner glassner(scene, options);
    const octree::Gargantini gargantini(scene, options);
    Random random(seed);
    std::uint64_t searched = 0;
    WorkCounters from_root;
    WorkCounters in_order;
    for (int i = 0; i < 100; ++i) {
      const Ray ray = tests::random_ray(scene, random);
      glassner.closest_hit(ray, &from_root);
      gargantini.closest_hit(ray, &in_order);
      searched += levels_of(glassner.path(ray));
    }
    EXPECT_EQ(from_root.get(Counter::kTraversalSteps), searched);
    EXPECT_EQ(in_order.get(Counter::kLeaves), from_root.get(Counter::kLeaves));
    EXPECT_EQ(in_order.get(Counter::kPrimitiveTests), from_root.get(Counter::kPrimitiveTests));
    EXPECT_GE(in_order.get(Counter::kTraversalSteps), in_order.get(Counter::kLeaves));
    EXPECT_LE(in_order.get(Counter::kTraversalSteps), searched);
  }
}

}  // namespace
}  // namespace beambench::accel

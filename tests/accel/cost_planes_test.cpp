// Octrees with planes at the lowest cost, and octrees divided on demand.

#include "accel/octree/cost_planes.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "accel/core/tolerance.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "accel/octree/for_each_node.hpp"
#include "accel/octree/from_root.hpp"
#include "accel/octree/samet.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "tests/accel/built.hpp"
#include "tests/hits_of_exhaustive.hpp"
#include "tests/random_scene.hpp"
#include "tests/scenes/thrown_message.hpp"

namespace beambench::accel {
namespace {

using octree::OctreeOptions;

OctreeOptions some_cost_options(std::uint64_t number) {
  OctreeOptions options;
  options.planes = OctreeOptions::Planes::kCost;
  options.max_level = static_cast<int>(1 + number % 6);
  options.max_objects = static_cast<std::uint32_t>(number % 3);
  if (number % 4 == 1) options.root = OctreeOptions::Root::kBox;
  if (number % 5 == 2) options.assign = OctreeOptions::Assign::kBounds;
  return options;
}

/// Returns the planes of a cube of 16 cells along each axis that contains all primitives.
glm::ivec3 planes_of(const std::vector<CellRange>& ranges) {
  CellGrid grid;
  grid.cells = glm::ivec3(16);
  std::vector<scenes::PrimitiveId> all(ranges.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<scenes::PrimitiveId>(i);
  return octree::cost_planes(grid, glm::ivec3(0), glm::ivec3(16), ranges, all);
}

CellRange point(std::uint16_t x) { return {{x, 8, 8}, {x, 8, 8}}; }

// By hand: with x at 1, 2, 3 and 14 the object median is plane 3, the spatial median plane 8, and
// the rounded positions from one to the other are 8, 7, 7, 6, 6, 5, 5, 4, 4, 3. At a plane p from 4
// to 8, three of the four points lie below, and the half areas are 256 + 32 p and
// 256 + 32 (16 - p). The cost is 3 (256 + 32 p) + 768 - 32 p = 1536 + 64 p, which is lowest at
// p = 4: 1792. At p = 3 it is 2 (256 + 96) + 2 (256 + 416) = 2048.
TEST(CostPlanes, MinimizeTheCost) {
  EXPECT_EQ(planes_of({point(1), point(2), point(3), point(14)}).x, 4);
  EXPECT_EQ(planes_of({}), glm::ivec3(8)) << "without points, the spatial median";
  EXPECT_EQ(planes_of({point(5)}).y, 8) << "the spatial and the object median coincide";
}

TEST(CostPlanes, LeavesTileTheRootAndReferToWhatOverlapsThem) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 25);
    const octree::Octree octree(scene, some_cost_options(seed));
    const double tolerance = overlap_tolerance(scene);
    std::uint64_t volume = 0;
    octree::for_each_node(octree::BoxCursor(octree), [&](const octree::BoxCursor& leaf) {
      if (!leaf.is_leaf()) return;
      const auto& size = leaf.size();
      volume += static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y) *
                static_cast<std::uint64_t>(size.z);
      const auto references = octree.references(leaf.node());
      EXPECT_TRUE(std::is_sorted(references.begin(), references.end()));
      const Box box = octree.grid().box(leaf.corner(), size);
      for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
        if (!surface_overlaps(scene, id, box, tolerance)) continue;
        EXPECT_TRUE(std::binary_search(references.begin(), references.end(), id)) << id;
      }
    });
    EXPECT_EQ(volume, std::uint64_t{1} << 48U);
  }
}

TEST(CostPlanes, HitsMatchExhaustive) {
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 60);
    tests::expect_hits_of_exhaustive(
        scene, octree::GlassnerAnyPlanes(scene, some_cost_options(seed)), seed, 100);
    tests::expect_hits_of_exhaustive(
        scene, octree::GargantiniAnyPlanes(scene, some_cost_options(seed)), seed, 100);
  }
}

// Saving tests is the purpose of the option `planes=cost`.
TEST(CostPlanes, SaveTests) {
  const scenes::Scene scene = scenes::load_scene("balls:n=3");
  const auto work = [&](const char* spec) {
    HitBuffer buffer(64, 64, 1);
    WorkCounters counters;
    registry()
        .choose(parse_spec(spec))
        .build(scene)
        ->closest_hits(PrimaryRays(scene.cameras.front(), 64, 64, 1), buffer, {&counters});
    return counters.get(Counter::kPrimitiveTests);
  };
  EXPECT_LT(work("gargantini:planes=cost,max_level=6,max_objects=1"),
            0.9 * static_cast<double>(work("gargantini:max_level=6,max_objects=1")));
}

TEST(CostPlanes, ADeeperOctreeIsTheSameFromACoarserOne) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const scenes::Scene scene = tests::random_scene(seed, 40);
    OctreeOptions options = some_cost_options(seed);
    options.max_level = 3;
    const octree::Octree coarser(scene, options);
    options.max_level = 5;
    const octree::Octree fresh(scene, options);
    const octree::Octree deepened(scene, options, coarser);
    ASSERT_EQ(deepened.nodes().size(), fresh.nodes().size());
    ASSERT_EQ(deepened.reference_count(), fresh.reference_count());
    tests::expect_hits_of_exhaustive(
        scene, octree::GargantiniAnyPlanes(scene, octree::Octree(deepened)), seed, 50);
  }
}

TEST(CostPlanes, AreRefusedByNeighborSearch) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=2");
  for (const char* name : {"samet", "samet-net", "beam"}) {
    EXPECT_TRUE(scenes::says(tests::refusal(std::string(name) + ":planes=cost", scene),
                             {name, "'planes'", "glassner, gargantini", "max_level"}));
  }
  EXPECT_THROW(octree::Samet(scene, some_cost_options(4)), InputError);
  EXPECT_THROW(octree::SametNet(scene, some_cost_options(4)), InputError);
}

// A ray passes through the same leaves, no matter which rays divided them.
TEST(OnDemandOctree, WorkAndHitsMatchTheCompleteOctree) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 60);
    OctreeOptions options = some_cost_options(seed);
    options.built_level = static_cast<int>(1 + seed % 4);
    const octree::GlassnerAnyPlanes complete(scene, options);
    const octree::GlassnerOnDemand glassner(scene, options);
    const octree::GargantiniOnDemand gargantini(scene, options);
    options.planes = OctreeOptions::Planes::kMedian;
    const octree::Gargantini halved(scene, options);
    const octree::GargantiniOnDemand halved_on_demand(scene, options);
    Random random(seed);
    std::array<WorkCounters, 5> work;
    for (int i = 0; i < 60; ++i) {
      const Ray ray = tests::random_ray(scene, random);
      const auto hit = complete.closest_hit(ray, work.data());
      ASSERT_EQ(glassner.closest_hit(ray, &work[1]), hit);
      ASSERT_EQ(gargantini.closest_hit(ray, &work[2]), hit);
      ASSERT_EQ(halved.closest_hit(ray, &work[3]), hit);
      ASSERT_EQ(halved_on_demand.closest_hit(ray, &work[4]), hit);
    }
    EXPECT_EQ(work[1].by_name(), work[0].by_name());
    EXPECT_EQ(work[2].get(Counter::kLeaves), work[0].get(Counter::kLeaves));
    EXPECT_EQ(work[4].by_name(), work[3].by_name());
    EXPECT_LE(glassner.statistics().nodes, complete.statistics().nodes);
  }
}

// Without rays, only the upper levels exist; once all leaves are entered, the octree is complete.
TEST(OnDemandOctree, DividesWhereRaysEnter) {
  const scenes::Scene scene = scenes::load_scene("balls:n=2");
  OctreeOptions options;
  options.built_level = 3;
  const octree::GargantiniOnDemand structure(scene, options);
  const Statistics before = structure.statistics();
  EXPECT_EQ(before.depth, 3U);
  EXPECT_EQ(before.more.front().first, "undivided_nodes");
  EXPECT_GT(before.more.front().second, 0.0);
  HitBuffer buffer(64, 64, 1);
  structure.closest_hits(PrimaryRays(scene.cameras.front(), 64, 64, 1), buffer, {});
  const Statistics after = structure.statistics();
  EXPECT_GT(after.nodes, before.nodes);
  octree::for_each_node(octree::OnDemandCursor(structure.octree()), [](const auto&) {});
  const Statistics all = structure.statistics();
  const Statistics complete = octree::Octree(scene, options).statistics();
  EXPECT_LT(after.nodes, all.nodes);
  EXPECT_EQ(all.nodes, complete.nodes);
  EXPECT_EQ(all.references, complete.references);
  EXPECT_EQ(all.empty_leaves, complete.empty_leaves);
  EXPECT_EQ(all.more.front().second, 0.0);
}

TEST(OnDemandOctree, ThreadsDivideTheSameNodesTogether) {
  const scenes::Scene scene = scenes::load_scene("escena1");
  const PrimaryRays rays(scene.cameras.front(), 64, 64, 1);
  OctreeOptions options;
  options.built_level = 1;
  HitBuffer expected(64, 64, 1);
  octree::Gargantini(scene, options).closest_hits(rays, expected, {});
  for (int round = 0; round < 8; ++round) {
    const octree::GargantiniOnDemand structure(scene, options);
    std::array<std::optional<HitBuffer>, 4> found;
    {
      std::vector<std::jthread> threads;
      for (auto& buffer : found) {
        threads.emplace_back([&] {
          buffer.emplace(64, 64, 1);
          structure.closest_hits(rays, *buffer, {});
        });
      }
    }
    for (const auto& buffer : found) EXPECT_EQ(*buffer, expected);
  }
}

TEST(OnDemandOctree, RefusesUnsupportedOptions) {
  EXPECT_TRUE(scenes::says(
      tests::refusal("glassner:build=on-demand,max_level=auto", scenes::load_scene("tetra:n=2")),
      {"build=on-demand", "max_level", "a number from 1 to 16"}));
  // The cap applies to the lists created by rays.
  const scenes::Scene scene = scenes::load_scene("escena1");
  const auto structure =
      registry()
          .choose(parse_spec("gargantini:build=on-demand,built_level=1,max_references=50"))
          .build(scene);
  HitBuffer buffer(8, 8, 1);
  const std::string cap = scenes::thrown_message(
      [&] { structure->closest_hits(PrimaryRays(scene.cameras.front(), 8, 8, 1), buffer, {}); });
  EXPECT_TRUE(scenes::says(cap, {"more than 50 references", "max_references"}));
}

}  // namespace
}  // namespace beambench::accel

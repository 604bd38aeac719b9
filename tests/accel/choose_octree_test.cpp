// What must be true of octrees whose level is chosen automatically.

#include "accel/octree/choose_octree.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "accel/beam/beam_cost.hpp"
#include "accel/beam/beam_tracer.hpp"
#include "accel/registry.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/random_scene.hpp"

namespace beambench {
namespace {

void expect_same(const Octree& a, const Octree& b) {
  ASSERT_EQ(a.nodes().size(), b.nodes().size());
  EXPECT_EQ(a.grid().cells, b.grid().cells);
  EXPECT_EQ(a.deepest_level(), b.deepest_level());
  for (std::size_t i = 0; i < a.nodes().size(); ++i) {
    const OctreeNode& one = a.nodes()[i];
    const OctreeNode& other = b.nodes()[i];
    ASSERT_TRUE(one.parent == other.parent && one.first == other.first && one.count == other.count)
        << "node " << i;
    if (!one.is_leaf()) continue;
    ASSERT_TRUE(std::ranges::equal(a.references(one), b.references(other)));
  }
}

TEST(DeepenedOctree, IsTheOneBuiltAtOnce) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene = testing::random_scene(seed, 40);
    OctreeOptions options;
    options.max_objects = static_cast<std::uint32_t>(seed % 4);
    options.root = seed % 2 == 0 ? OctreeOptions::Root::kCube : OctreeOptions::Root::kBox;
    options.max_level = static_cast<int>(1 + seed % 4);
    const Octree coarser(scene, options);
    options.max_level += static_cast<int>(1 + seed % 3);
    expect_same(Octree(scene, options, coarser), Octree(scene, options));
  }
}

Octree chosen(const Scene& scene, std::size_t rays) {
  OctreeOptions options;
  options.max_level = OctreeOptions::kAutomatic;
  return choose_octree(scene, options, {scene.cameras.front(), rays}, samet_cost);
}

TEST(ChooseOctree, MoreRaysAreWorthADeeperTree) {
  for (const char* name : {"delfines", "maceta", "tetra:n=6"}) {
    SCOPED_TRACE(name);
    const Scene scene = load_scene(name);
    int last = 0;
    for (const std::size_t rays : {1'000UL, 64'000UL, 1'300'000UL, 100'000'000UL}) {
      const int level = chosen(scene, rays).deepest_level();
      EXPECT_GE(level, last) << rays;
      last = level;
    }
    EXPECT_GT(last, chosen(scene, 1'000).deepest_level());
  }
}

TEST(ChooseOctree, GivenLevelsAreKept) {
  const Scene scene = load_scene("delfines");
  OctreeOptions options;
  options.max_level = 5;
  expect_same(choose_octree(scene, options, usual_workload(scene), samet_cost),
              Octree(scene, options));
}

TEST(ChooseOctree, StopsBeforeTheCapOnReferences) {
  const Scene scene = load_scene("delfines");
  const std::uint64_t free = chosen(scene, 100'000'000).statistics().references;
  OctreeOptions options;
  options.max_level = OctreeOptions::kAutomatic;
  options.max_references = free / 2;
  const Octree octree =
      choose_octree(scene, options, {scene.cameras.front(), 100'000'000}, samet_cost);
  EXPECT_LE(octree.statistics().references, options.max_references);
}

TEST(ChooseOctree, ScenesWithNothingToSplitEnd) {
  const Scene empty = SceneBuilder("empty").build();
  EXPECT_EQ(chosen(empty, 1'000'000).statistics().nodes, 1U);
}

TEST(CountBeams, AreThoseThatTheTracerCounts) {
  for (const char* name : {"delfines", "escena2", "habitacion"}) {
    SCOPED_TRACE(name);
    const Scene scene = load_scene(name);
    BeamOptions options;
    options.octree.max_level = 5;
    const BeamTracer tracer(scene, options);
    const PrimaryRays rays(scene.cameras.front(), 64, 48, 1);
    HitBuffer hits(64, 48, 1);
    WorkCounters counters;
    tracer.trace(rays, hits, counters);
    OctreeWork work{};
    count_beams(tracer.octree(), scene.cameras.front(), work);
    const auto counts = counters.by_name();
    // The image is widened by rounding, which is coarser or finer at other resolutions.
    EXPECT_NEAR(work.nonterminal, static_cast<double>(counts.at("beams_nonterminal")),
                0.002 * work.nonterminal + 2.0);
    EXPECT_NEAR(work.occupied, static_cast<double>(counts.at("beams_occupied")),
                0.002 * work.occupied + 2.0);
  }
}

TEST(BeamCost, CrowdsOfBeamsMakeItChooseAShallowerTreeThanRaysDo) {
  const Scene scene = load_scene("maceta");
  const Workload workload{scene.cameras.front(), 64'000};
  const auto depth = [&](const std::string& spec) {
    return registry().choose(parse_spec(spec)).build(scene, workload)->statistics().depth;
  };
  EXPECT_LT(depth("beam:max_level=auto"), depth("samet:max_level=auto"));
  EXPECT_LE(depth("beam:max_level=auto"), depth("beam:max_level=auto,handover=48"));
}

}  // namespace
}  // namespace beambench

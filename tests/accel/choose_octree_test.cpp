// Properties of octrees whose level is chosen automatically.

#include "accel/octree/choose_octree.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "accel/beam/beam_cost.hpp"
#include "accel/beam/beam_tracer.hpp"
#include "accel/core/registry.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

void expect_same(const octree::Octree& a, const octree::Octree& b) {
  ASSERT_EQ(a.nodes().size(), b.nodes().size());
  EXPECT_EQ(a.grid().cells, b.grid().cells);
  EXPECT_EQ(a.deepest_level(), b.deepest_level());
  for (std::size_t i = 0; i < a.nodes().size(); ++i) {
    const octree::OctreeNode& one = a.nodes()[i];
    const octree::OctreeNode& other = b.nodes()[i];
    ASSERT_TRUE(one.parent == other.parent && one.first == other.first && one.count == other.count)
        << "node " << i;
    if (!one.is_leaf()) continue;
    ASSERT_TRUE(std::ranges::equal(a.references(one), b.references(other)));
  }
}

TEST(DeepenedOctree, EqualsOneBuiltDirectly) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 40);
    octree::OctreeOptions options;
    options.max_objects = static_cast<std::uint32_t>(seed % 4);
    options.root =
        seed % 2 == 0 ? octree::OctreeOptions::Root::kCube : octree::OctreeOptions::Root::kBox;
    options.max_level = static_cast<int>(1 + seed % 4);
    const octree::Octree coarser(scene, options);
    options.max_level += static_cast<int>(1 + seed % 3);
    expect_same(octree::Octree(scene, options, coarser), octree::Octree(scene, options));
  }
}

octree::Octree chosen(const scenes::Scene& scene, std::size_t rays) {
  octree::OctreeOptions options;
  options.max_level = octree::OctreeOptions::kAutomatic;
  return octree::choose_octree(scene, options, {scene.cameras.front(), rays},
                               octree::samet_trace_cost);
}

TEST(ChooseOctree, MoreRaysJustifyADeeperTree) {
  for (const char* name : {"delfines", "maceta", "tetra:n=6"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
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
  const scenes::Scene scene = scenes::load_scene("delfines");
  octree::OctreeOptions options;
  options.max_level = 5;
  expect_same(
      octree::choose_octree(scene, options, usual_workload(scene), octree::samet_trace_cost),
      octree::Octree(scene, options));
}

TEST(ChooseOctree, StopsBeforeTheCapOnReferences) {
  const scenes::Scene scene = scenes::load_scene("delfines");
  const std::uint64_t free = chosen(scene, 100'000'000).statistics().references;
  octree::OctreeOptions options;
  options.max_level = octree::OctreeOptions::kAutomatic;
  options.max_references = free / 2;
  const octree::Octree octree = octree::choose_octree(
      scene, options, {scene.cameras.front(), 100'000'000}, octree::samet_trace_cost);
  EXPECT_LE(octree.statistics().references, options.max_references);
}

TEST(ChooseOctree, ScenesWithNothingToSplitTerminate) {
  const scenes::Scene empty = scenes::SceneBuilder("empty").build();
  EXPECT_EQ(chosen(empty, 1'000'000).statistics().nodes, 1U);
}

/// Returns the beams of an image as the tracer counts them.
octree::OctreeWork traced_beams(const beam::BeamTracer& tracer, const scenes::Camera& camera) {
  const PrimaryRays rays(camera, 64, 48, 1);
  HitBuffer hits(64, 48, 1);
  WorkCounters counters;
  tracer.closest_hits(rays, hits, {&counters});
  const auto counts = counters.by_name();
  octree::OctreeWork work{};
  work.nonterminal = static_cast<double>(counts.at("beams_nonterminal"));
  work.occupied = static_cast<double>(counts.at("beams_occupied"));
  return work;
}

TEST(CountBeams, EstimatesWhatTheTracerCounts) {
  octree::OctreeWork traced{};
  octree::OctreeWork estimated{};
  for (const char* name : {"delfines", "maceta", "misil", "tetera", "stetra", "casa-de-campo"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    const scenes::Camera& camera = scene.cameras.front();
    beam::BeamOptions options;
    options.octree.max_level = 6;
    const beam::BeamTracer tracer(scene, options);
    const octree::OctreeWork truth = traced_beams(tracer, camera);
    octree::OctreeWork work{};
    beam::count_beams(tracer.octree(), {camera, 64'000}, {}, work);
    // Beams crowd together at some edges, which may or may not be in a window.
    EXPECT_NEAR(work.nonterminal, truth.nonterminal, 0.5 * truth.nonterminal);
    EXPECT_NEAR(work.occupied, truth.occupied, 0.5 * truth.occupied);
    traced.nonterminal += truth.nonterminal;
    traced.occupied += truth.occupied;
    estimated.nonterminal += work.nonterminal;
    estimated.occupied += work.occupied;
  }
  // The errors of different scenes cancel out; counting all beams visible in a window would find
  // twice as many.
  EXPECT_NEAR(estimated.nonterminal, traced.nonterminal, 0.15 * traced.nonterminal);
  EXPECT_NEAR(estimated.occupied, traced.occupied, 0.15 * traced.occupied);
}

TEST(CountBeams, UsesSmallWindowsIfManyAreExpected) {
  const scenes::Scene scene = scenes::load_scene("stetra");
  const Workload workload{scene.cameras.front(), 64'000};
  octree::OctreeOptions options;
  options.max_level = 7;
  const octree::Octree octree(scene, options);
  octree::OctreeWork many{};
  many.nonterminal = 1e9;
  octree::OctreeWork wide{};
  octree::OctreeWork small{};
  beam::count_beams(octree, workload, {}, wide);
  beam::count_beams(octree, workload, many, small);
  EXPECT_GT(small.nonterminal, 0.5 * wide.nonterminal);
  EXPECT_LT(small.nonterminal, 2.0 * wide.nonterminal);
  EXPECT_NE(small.nonterminal, wide.nonterminal);
}

TEST(BeamCost, ManyBeamsFavorAShallowerTreeThanRays) {
  const scenes::Scene scene = scenes::load_scene("tetera");
  const Workload workload{scene.cameras.front(), 64'000};
  const auto depth = [&](const std::string& spec) {
    return registry().choose(parse_spec(spec)).build(scene, workload)->statistics().depth;
  };
  EXPECT_LT(depth("beam:max_level=auto"), depth("samet:max_level=auto"));
  EXPECT_LE(depth("beam:max_level=auto"), depth("beam:max_level=auto,handover=48"));
}

}  // namespace
}  // namespace beambench::accel

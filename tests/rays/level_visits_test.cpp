// Visits of an octree's nodes by level.

#include "harness/rays/level_visits.hpp"

#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::rays {
namespace {

struct Visited {
  std::vector<LevelVisits> levels;
  accel::Statistics sizes;
  accel::WorkCounters work;
};

Visited visited(const std::string& spec) {
  const scenes::Scene scene = scenes::load_scene("maceta");
  const accel::PrimaryRays rays(scene.cameras.front(), 64, 50, 1);
  const auto structure = accel::registry().choose(parse_spec(spec)).build(scene);
  Visited found{count_level_visits(*structure, TraceInput(rays)), structure->statistics(), {}};
  accel::HitBuffer hits(rays.width(), rays.height(), 1);
  structure->closest_hits(rays, hits, {&found.work});
  return found;
}

TEST(LevelVisits, HoldEveryNodeAndEveryLeafThatARayEnters) {
  for (const std::string spec : {"samet:max_level=6", "samet-net:max_level=6"}) {
    SCOPED_TRACE(spec);
    const Visited found = visited(spec);
    ASSERT_EQ(found.levels.size(), found.sizes.depth);
    std::uint64_t nodes = 0;
    std::uint64_t leaves = 0;
    std::uint64_t occupied = 0;
    std::uint64_t visits = 0;
    for (const LevelVisits& level : found.levels) {
      nodes += level.nodes;
      leaves += level.leaves;
      occupied += level.occupied_leaves;
      visits += level.leaf_visits;
      EXPECT_EQ(level.beams, 0U);
    }
    EXPECT_EQ(nodes, found.sizes.nodes);
    EXPECT_EQ(leaves, found.sizes.leaves);
    EXPECT_EQ(occupied, found.sizes.leaves - found.sizes.empty_leaves);
    EXPECT_EQ(visits, found.work.get(accel::Counter::kLeaves));
  }
}

TEST(LevelVisits, CountARayOnceForEachNodeItPassesThrough) {
  const std::vector<LevelVisits> levels = visited("samet:max_level=6").levels;
  // At the root, each ray that enters is counted once. On deeper levels, a ray passes at least as
  // many nodes as leaves on this level, and at most as many as leaves on this and deeper levels.
  EXPECT_LE(levels[0].node_visits, 64U * 50U);
  EXPECT_GT(levels[0].node_visits, 64U * 50U / 2);
  std::uint64_t below = 0;
  for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
    below += level->leaf_visits;
    EXPECT_GE(level->node_visits, level->leaf_visits) << level->level;
    EXPECT_LE(level->node_visits, below) << level->level;
  }
}

TEST(LevelVisits, CountBeamsAtTheLeavesThatTheyReach) {
  const Visited found = visited("beam:max_level=6");
  const auto counters = found.work.by_name();
  std::uint64_t beams = 0;
  for (const LevelVisits& level : found.levels) beams += level.beams;
  EXPECT_GT(beams, 0U);
  EXPECT_EQ(beams, counters.at("beams_nonterminal") + counters.at("beams_occupied"));
}

TEST(LevelVisits, AreEmptyWithoutAnOctree) {
  EXPECT_TRUE(visited("voxel-grid").levels.empty());
  EXPECT_TRUE(visited("sah-bvh").levels.empty());
}

}  // namespace
}  // namespace beambench::rays

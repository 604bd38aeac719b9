// The net over an octree: its links lead to Samet's neighbors, and it saves only the search for
// them.

#include "accel/octree/octree_net.hpp"

#include <gtest/gtest.h>

#include "accel/octree/samet.hpp"
#include "scenes/catalogue.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

octree::OctreeOptions small_octree(std::uint64_t seed) {
  octree::OctreeOptions options;
  options.max_level = static_cast<int>(1 + seed % 5);
  options.max_objects = static_cast<std::uint32_t>(seed % 3);
  return options;
}

/// Calls visit(cursor) at every node.
void for_each_node(const octree::Octree& octree, const octree::OctreeCursor& cursor,
                   const auto& visit) {
  visit(cursor);
  if (cursor.node().is_leaf()) return;
  const std::int32_t half = cursor.size() / 2;
  for (std::uint32_t octant = 0; octant < 8; ++octant) {
    const glm::ivec3 offset(octant & 1U, (octant >> 1U) & 1U, octant >> 2U);
    octree::OctreeCursor child = cursor;
    child.jump(cursor.node().first + octant, cursor.corner() + offset * half, half);
    for_each_node(octree, child, visit);
  }
}

TEST(OctreeNet, EachLinkLeadsToSametsNeighbor) {
  std::uint64_t links = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 20);
    const octree::Octree octree(scene, small_octree(seed));
    const octree::OctreeNet net(octree);
    for_each_node(octree, octree::OctreeCursor(octree), [&](const octree::OctreeCursor& node) {
      for (int face = 0; face < 6; ++face) {
        glm::ivec3 step(0);
        step[face / 2] = face % 2 == 0 ? -1 : 1;
        octree::OctreeCursor expected = node;
        octree::OctreeCursor actual = node;
        if (octree::AncestorNeighbors::move(expected, step) == 0) {
          ASSERT_EQ(net.neighbor(node.index(), face), octree::OctreeNet::kOutside);
          ASSERT_EQ(net.move(actual, step), 0);
          continue;
        }
        ASSERT_EQ(net.move(actual, step), 1);
        ASSERT_EQ(actual.index(), expected.index());
        ASSERT_EQ(actual.corner(), expected.corner());
        ASSERT_EQ(actual.size(), expected.size());
        ++links;
      }
    });
  }
  EXPECT_GT(links, 10'000U);
}

TEST(OctreeNet, LeavesTheirOrderAndTestsMatchSamet) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 25);
    const octree::Samet samet(scene, small_octree(seed));
    const octree::SametNet net(scene, small_octree(seed));
    Random random(seed);
    for (int i = 0; i < 100; ++i) {
      const Ray ray = tests::random_ray(scene, random);
      const auto expected = samet.path(ray);
      const auto actual = net.path(ray);
      ASSERT_EQ(actual.size(), expected.size());
      for (std::size_t step = 0; step < actual.size(); ++step) {
        ASSERT_EQ(actual[step].index, expected[step].index);
        ASSERT_EQ(actual[step].level, expected[step].level);
        ASSERT_EQ(actual[step].t_enter, expected[step].t_enter);
        ASSERT_EQ(actual[step].t_exit, expected[step].t_exit);
        ASSERT_EQ(actual[step].tests.size(), expected[step].tests.size());
      }
    }
  }
}

TEST(OctreeNet, TakesOneStepWhereSametClimbs) {
  for (const char* name : {"tetra:n=4", "balls:n=2", "escena1"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    const PrimaryRays rays(scene.cameras.front(), 64, 64, 1);
    const auto count = [&](const Accelerator& structure) {
      HitBuffer buffer(64, 64, 1);
      WorkCounters counters;
      structure.closest_hits(rays, buffer, {&counters});
      return counters.by_name();
    };
    auto samet = count(octree::Samet(scene, {}));
    auto net = count(octree::SametNet(scene, {}));
    EXPECT_EQ(net["leaves"], samet["leaves"]);
    EXPECT_EQ(net["empty_leaves"], samet["empty_leaves"]);
    EXPECT_EQ(net["primitive_tests"], samet["primitive_tests"]);
    // A ray moves on at most once from each leaf on its path.
    EXPECT_LE(net["neighbor_steps"], net["leaves"]);
    EXPECT_GT(net["neighbor_steps"], net["leaves"] / 2);
    EXPECT_GT(samet["neighbor_steps"], 2 * net["neighbor_steps"]);
    // Only the search for the neighbor is saved.
    EXPECT_EQ(samet["traversal_steps"] - net["traversal_steps"],
              samet["neighbor_steps"] - net["neighbor_steps"]);
  }
}

TEST(OctreeNet, ReportsTheMemoryOfItsLinks) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=4");
  const Statistics samet = octree::Samet(scene, {}).statistics();
  const Statistics net = octree::SametNet(scene, {}).statistics();
  EXPECT_EQ(net.nodes, samet.nodes);
  EXPECT_EQ(net.references, samet.references);
  ASSERT_EQ(net.more.size(), samet.more.size() + 1);
  EXPECT_EQ(net.more.back().first, "net_bytes");
  EXPECT_EQ(static_cast<double>(net.bytes - samet.bytes), net.more.back().second);
  EXPECT_GE(net.bytes - samet.bytes, 32 * net.nodes);
}

}  // namespace
}  // namespace beambench::accel

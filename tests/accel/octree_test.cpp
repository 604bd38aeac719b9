// The octree: published counts, invariants, its cap.

#include "accel/octree/octree.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "accel/core/tolerance.hpp"
#include "scenes/catalogue.hpp"
#include "tests/accel/built.hpp"
#include "tests/random_scene.hpp"
#include "tests/scenes/thrown_message.hpp"

namespace beambench::accel {
namespace {

struct HavranRow {
  int depth;
  std::uint64_t interior, leaves, empty_leaves, references;
};

// Havran, "A Summary of Octree Ray Traversal Algorithms", Ray Tracing News 12(2), 1999, TETRA at
// n = 6. Nodes are split at the center down to one object or the maximum depth (the root has depth
// 0). Objects are represented by their bounding boxes, and the root is the scene's own box.
class Havran : public ::testing::TestWithParam<HavranRow> {};

TEST_P(Havran, CountsOfTetra) {
  static const scenes::Scene scene = scenes::load_scene("tetra:n=6");
  const HavranRow& row = GetParam();
  octree::OctreeOptions options;
  options.max_level = row.depth + 1;
  options.max_objects = 1;
  options.root = octree::OctreeOptions::Root::kBox;
  options.assign = octree::OctreeOptions::Assign::kBounds;
  options.pad = 1e-6;
  const Statistics statistics = octree::Octree(scene, options).statistics();
  EXPECT_EQ(statistics.nodes - statistics.leaves, row.interior);
  EXPECT_EQ(statistics.leaves, row.leaves);
  EXPECT_EQ(statistics.empty_leaves, row.empty_leaves);
  EXPECT_EQ(statistics.references, row.references);
  EXPECT_EQ(statistics.depth, static_cast<std::uint64_t>(options.max_level));
}

INSTANTIATE_TEST_SUITE_P(Depths, Havran,
                         ::testing::Values(HavranRow{4, 305, 2'136, 1'072, 13'312},
                                           HavranRow{5, 1'369, 9'584, 4'764, 32'768},
                                           HavranRow{6, 6'189, 43'324, 21'100, 110'592},
                                           HavranRow{7, 28'413, 198'892, 80'444, 512'000}),
                         [](const auto& info) {
                           return "Depth" + std::to_string(info.param.depth);
                         });

/// Visits all leaves with their positions.
void for_each_leaf(const octree::Octree& octree, std::uint32_t index, const glm::ivec3& corner,
                   std::int32_t size, const auto& visit) {
  const octree::OctreeNode& node = octree.nodes()[index];
  if (node.is_leaf()) {
    visit(node, corner, size);
    return;
  }
  for (std::uint32_t octant = 0; octant < 8; ++octant) {
    EXPECT_EQ(octree.nodes()[node.first + octant].parent, index);
    const glm::ivec3 offset(octant & 1U, (octant >> 1U) & 1U, octant >> 2U);
    for_each_leaf(octree, node.first + octant, corner + offset * (size / 2), size / 2, visit);
  }
}

// The builder takes shortcuts (integer cell ranges); the definition does not.
TEST(Octree, LeavesReferToExactlyWhatOverlapsThem) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 25);
    octree::OctreeOptions options;
    options.max_level = static_cast<int>(2 + seed % 4);
    options.max_objects = static_cast<std::uint32_t>(seed % 3);
    const octree::Octree octree(scene, options);
    std::uint64_t volume = 0;
    for_each_leaf(octree, 0, glm::ivec3(0), octree.grid().cells.x,
                  [&](const octree::OctreeNode& leaf, const glm::ivec3& corner, std::int32_t size) {
                    volume += static_cast<std::uint64_t>(size) * size * size;
                    const auto references = octree.references(leaf);
                    std::vector<scenes::PrimitiveId> expected;
                    for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
                      if (surface_overlaps(scene, id, octree.grid().box(corner, size),
                                           overlap_tolerance(scene))) {
                        expected.push_back(id);
                      }
                    }
                    EXPECT_TRUE(std::includes(references.begin(), references.end(),
                                              expected.begin(), expected.end()));
                    EXPECT_TRUE(std::is_sorted(references.begin(), references.end()));
                    // References beyond the definition are allowed only within rounding of the
                    // boundary, except for cones, whose overlap test is conservative.
                    for (const scenes::PrimitiveId id : references) {
                      if (scene.primitives[id].kind == scenes::PrimitiveKind::kCone) continue;
                      EXPECT_TRUE(surface_overlaps(scene, id, octree.grid().box(corner, size),
                                                   3.0 * overlap_tolerance(scene)));
                    }
                  });
    const auto cells = static_cast<std::uint64_t>(octree.grid().cells.x);
    EXPECT_EQ(volume, cells * cells * cells) << "leaves tile the root";
  }
}

TEST(Octree, SplitsWhileALeafHoldsMoreThanMaxObjects) {
  const scenes::Scene scene = scenes::load_scene("balls:n=2");
  for (const std::uint32_t max_objects : {0U, 1U, 10U, 40U}) {
    octree::OctreeOptions options;
    options.max_objects = max_objects;
    options.max_level = 6;
    const octree::Octree octree(scene, options);
    for_each_leaf(octree, 0, glm::ivec3(0), octree.grid().cells.x,
                  [&](const octree::OctreeNode& leaf, const glm::ivec3&, std::int32_t size) {
                    EXPECT_TRUE(leaf.count <= max_objects || size == 1);
                  });
  }
}

TEST(Octree, MaxLevelCountsTheRootAsOne) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=2");
  octree::OctreeOptions options;
  options.max_level = 1;
  EXPECT_EQ(octree::Octree(scene, options).statistics().nodes, 1U);
  options.max_level = 6;
  EXPECT_EQ(octree::Octree(scene, options).grid().cells.x, 32)
      << "thesis: level 6 is 32 cells per axis";
}

TEST(Octree, CapOnReferencesIsAClearError) {
  const scenes::Scene scene = scenes::load_scene("escena1");
  EXPECT_TRUE(scenes::says(
      tests::refusal("samet:max_level=8,max_references=1000", scene),
      {"max_level 8", "430 primitives", "more than 1000 references", "max_references"}));
}

}  // namespace
}  // namespace beambench::accel

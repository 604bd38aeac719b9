// The hierarchy of grids: the contents of its voxels, which of them are divided, and its limits.

#include "accel/hierarchical_grid/hierarchical_grid.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "accel/core/overlap.hpp"
#include "accel/core/registry.hpp"
#include "accel/core/tolerance.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "accel/grid/mailboxes.hpp"
#include "accel/grid/voxel_walk.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/accel/built.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

using hierarchical_grid::GridHierarchy;
using hierarchical_grid::HierarchicalGridOptions;
using hierarchical_grid::NestedGrid;
using hierarchical_grid::Voxel;
using tests::build;
using tests::refusal;

/// Returns the options of a test, by number: coarse and fine grids, cubic or not, few and many
/// levels.
HierarchicalGridOptions some_grid_options(std::uint64_t number) {
  HierarchicalGridOptions options;
  if (number % 3 != 0) {
    const auto n = static_cast<std::int32_t>(number);
    options.resolution = {1 + n % 4, 1 + n % 3, 1 + n % 5};
  }
  options.inner_density = number % 2 == 0 ? 4.0 : 0.7;
  options.max_objects = static_cast<std::uint32_t>(number % 4);
  options.max_level = 1 + static_cast<int>(number % 5);
  if (number % 7 == 0) options.shape = grid::Shape::kEqual;
  if (number % 3 == 1) options.divide = HierarchicalGridOptions::Divide::kAlways;
  return options;
}

/// Calls `visit(voxel, box)` for the undivided voxels.
template <class Visit>
void for_each_leaf(const GridHierarchy& hierarchy, Visit visit) {
  for (const NestedGrid& grid : hierarchy.grids()) {
    for (std::size_t i = 0; i < grid::voxel_count(grid.place()); ++i) {
      const Voxel voxel = hierarchy.voxel(grid.first_voxel + i);
      if (!voxel.is_divided()) visit(voxel, grid.place().box(grid::voxel_at(grid.place(), i), 1));
    }
  }
}

double volume(const Box& box) {
  const glm::dvec3 size = box.upper - box.lower;
  return size.x * size.y * size.z;
}

// The builder passes lists down and halves blocks of voxels; the definition does not.
TEST(HierarchicalGrid, VoxelsReferToExactlyWhatOverlapsThem) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 25);
    const GridHierarchy hierarchy(scene, some_grid_options(seed));
    const double tolerance = overlap_tolerance(scene);
    double sum = 0.0;
    for_each_leaf(hierarchy, [&](Voxel voxel, const Box& box) {
      sum += volume(box);
      const auto references = hierarchy.references(voxel);
      EXPECT_TRUE(std::is_sorted(references.begin(), references.end()));
      for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
        // The overlap test of cones is conservative, in different ways for a voxel and its parts.
        if (scene.primitives[id].kind == scenes::PrimitiveKind::kCone) continue;
        const bool listed = std::binary_search(references.begin(), references.end(), id);
        EXPECT_TRUE(listed || !surface_overlaps(scene, id, box, 0.999 * tolerance)) << id;
        if (!listed) continue;
        EXPECT_TRUE(surface_overlaps(scene, id, box, 3.0 * tolerance)) << id;
      }
    });
    const CellGrid& top = hierarchy.top().place();
    EXPECT_NEAR(sum / volume(top.box(glm::ivec3(0), top.cells)), 1.0, 1e-9) << "they tile the box";
  }
}

TEST(HierarchicalGrid, EveryOptionMatchesExhaustive) {
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 80);
    HierarchicalGridOptions options = some_grid_options(seed);
    if (seed % 4 == 2) options.assign = grid::Assign::kBounds;
    const hierarchical_grid::HierarchicalGrid<NoMailboxes> plain(scene, options);
    const hierarchical_grid::HierarchicalGrid<grid::Mailboxes> mailboxes(scene, options);
    const exhaustive::Exhaustive exhaustive(scene);
    Random random(seed);
    for (int i = 0; i < 300; ++i) {
      const Ray ray = tests::random_ray(scene, random);
      const auto hit = exhaustive.closest_hit(ray, nullptr);
      ASSERT_EQ(plain.closest_hit(ray, nullptr), hit) << "ray " << i;
      ASSERT_EQ(mailboxes.closest_hit(ray, nullptr), hit) << "ray " << i;
      ASSERT_EQ(plain.any_hit(ray, nullptr), hit.has_value()) << "ray " << i;
      ASSERT_EQ(mailboxes.any_hit(ray, nullptr), hit.has_value()) << "ray " << i;
    }
  }
}

TEST(HierarchicalGrid, VoxelsAlongARayFollowEachOther) {
  const scenes::Scene scene = scenes::load_scene("escena2");
  const auto structure =
      build("hierarchical-grid:resolution=5x3x4,max_objects=1,max_level=5", scene);
  Random random(1);
  std::size_t deep = 0;
  for (int i = 0; i < 300; ++i) {
    const auto steps = structure->inspector()->path(tests::random_ray(scene, random));
    double left_at = 0.0;
    bool first = true;
    for (const TraceStep& step : steps) {
      EXPECT_LE(step.t_enter, step.t_exit);
      if (step.level > 2) ++deep;
      if (step.place != "leaf") continue;
      if (!first) {
        EXPECT_EQ(step.t_enter, std::max(left_at, steps[0].t_enter));
      }
      left_at = step.t_exit;
      first = false;
    }
  }
  EXPECT_GT(deep, 100U) << "the rays must have been in inner grids";
}

// A grid of 2 x 2 x 2 voxels, one of which has two spheres and is divided, by hand.
TEST(HierarchicalGrid, DividesTheVoxelsThatReferToMore) {
  scenes::SceneBuilder builder("three");
  builder.add_sphere({0.2, 0.2, 0.2}, 0.2);
  builder.add_sphere({0.6, 0.6, 0.6}, 0.2);
  builder.add_sphere({1.8, 1.8, 1.8}, 0.2);
  const scenes::Scene scene = std::move(builder).build();
  HierarchicalGridOptions options;
  options.resolution = {2, 2, 2};
  options.inner_density = 4.0;
  options.max_objects = 1;
  options.max_level = 2;
  options.divide = HierarchicalGridOptions::Divide::kAlways;
  const GridHierarchy hierarchy(scene, options);
  ASSERT_EQ(hierarchy.grids().size(), 2U);
  EXPECT_EQ(hierarchy.grids()[1].place().cells, glm::ivec3(2));
  const Statistics statistics = hierarchy.statistics();
  EXPECT_EQ(statistics.nodes, 1U + 8U + 8U);
  EXPECT_EQ(statistics.leaves, 7U + 8U);
  EXPECT_EQ(statistics.empty_leaves, 6U);
  EXPECT_EQ(statistics.references, 1U + 1U + 8U)
      << "the second sphere surrounds the center of its voxel";
  EXPECT_EQ(statistics.depth, 3U);
}

TEST(HierarchicalGrid, AnotherLevelIsMadeOnlyIfItSavesTime) {
  scenes::SceneBuilder builder("pile");
  for (int i = 0; i < 50; ++i) builder.add_sphere({0.0, 0.0, 0.0}, 1.0);
  const scenes::Scene scene = std::move(builder).build();
  HierarchicalGridOptions options;
  options.resolution = {1, 1, 1};
  options.inner_density = 0.16;
  EXPECT_EQ(GridHierarchy(scene, options).grids().size(), 1U)
      << "each of the 8 voxels would refer to all spheres";
  options.divide = HierarchicalGridOptions::Divide::kAlways;
  EXPECT_GT(GridHierarchy(scene, options).grids().size(), 1U);
}

TEST(HierarchicalGrid, LimitsAreRefusedOrKept) {
  const scenes::Scene scene = scenes::load_scene("balls:n=3");
  const std::string too_fine =
      refusal("hierarchical-grid:resolution=4096,max_voxels=1000000", scene);
  for (const char* word : {"4096x4096x4096", "max_voxels", "resolution"}) {
    EXPECT_NE(too_fine.find(word), std::string::npos) << too_fine;
  }
  const std::string too_many = refusal(
      "hierarchical-grid:divide=always,inner_density=8,max_objects=0,max_references=4000", scene);
  for (const char* word : {"4000 references", "max_references", "inner_density"}) {
    EXPECT_NE(too_many.find(word), std::string::npos) << too_many;
  }
  const auto few = build("hierarchical-grid:max_references=4000,max_objects=0", scene);
  EXPECT_LE(few->statistics().references, 4000U);
  const auto free = build("hierarchical-grid:resolution=8", scene)->statistics();
  const auto small = build("hierarchical-grid:resolution=8,max_voxels=600", scene)->statistics();
  EXPECT_GT(free.nodes, 601U);
  EXPECT_LE(small.nodes, 601U);
}

TEST(HierarchicalGrid, OneLevelIsTheGridOfVoxels) {
  for (const char* name : {"tetra:n=4", "balls:n=2", "escena1"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    const auto one =
        build("hierarchical-grid:resolution=16x9x12,max_level=1,mailboxes=false", scene);
    const auto voxels = build("voxel-grid:resolution=16x9x12", scene);
    EXPECT_EQ(one->statistics().references, voxels->statistics().references);
    EXPECT_EQ(one->statistics().empty_leaves, voxels->statistics().empty_leaves);
    const PrimaryRays rays(scene.cameras.front(), 64, 64, 1);
    const auto work = [&](const Accelerator& structure) {
      HitBuffer buffer(64, 64, 1);
      WorkCounters counters;
      structure.closest_hits(rays, buffer, {&counters});
      return counters.by_name();
    };
    EXPECT_EQ(work(*one), work(*voxels));
  }
}

TEST(HierarchicalGrid, AnEmptySceneHasNoHits) {
  const scenes::Scene scene = scenes::SceneBuilder("nothing").build();
  const auto structure = build("hierarchical-grid", scene);
  EXPECT_FALSE(structure->closest_hit({{0, 0, -5}, 0, {0, 0, 1}, 100}, nullptr));
  EXPECT_EQ(structure->statistics().references, 0U);
}

}  // namespace
}  // namespace beambench::accel

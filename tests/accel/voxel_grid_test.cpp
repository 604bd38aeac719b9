// The voxel grid: its lists, the two ways to fill them, caps, mailboxes and threads.

#include "accel/grid/voxel_grid.hpp"

#include <algorithm>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "accel/core/tolerance.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "accel/grid/eager_voxels.hpp"
#include "accel/grid/lazy_voxels.hpp"
#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/accel/built.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

using tests::build;
using tests::refusal;

constexpr std::uint64_t kNoCap = 1'000'000'000;

grid::VoxelGridOptions with_resolution(std::int32_t x, std::int32_t y, std::int32_t z) {
  grid::VoxelGridOptions options;
  options.resolution = {x, y, z};
  return options;
}

double more(const Statistics& statistics, std::string_view name) {
  const auto found = std::find_if(statistics.more.begin(), statistics.more.end(),
                                  [&](const auto& pair) { return pair.first == name; });
  return found == statistics.more.end() ? -1.0 : found->second;
}

// The builder halves blocks of voxels and takes shortcuts; the definition does not.
TEST(VoxelGrid, ListsHoldExactlyWhatOverlapsTheVoxel) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 25);
    const auto n = static_cast<std::int32_t>(seed);
    const CellGrid grid =
        grid::make_voxel_grid(scene, with_resolution(1 + n % 7, 1 + n % 5, 1 + n % 9));
    const grid::EagerVoxels eager(scene, grid, kNoCap);
    const grid::LazyVoxels lazy(scene, grid, kNoCap);
    for (std::size_t voxel = 0; voxel < grid::voxel_count(grid); ++voxel) {
      const Box box = grid.box(grid::voxel_at(grid, voxel), 1);
      for (const auto& references : {eager.references(voxel), lazy.references(voxel)}) {
        EXPECT_TRUE(std::is_sorted(references.begin(), references.end()));
        for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
          const bool listed = std::binary_search(references.begin(), references.end(), id);
          if (listed == surface_overlaps(scene, id, box, overlap_tolerance(scene))) continue;
          // Lists may exceed the definition only within rounding of the boundary. The overlap test
          // of cones is conservative: it may be true for a voxel but false for a surrounding block.
          if (scene.primitives[id].kind == scenes::PrimitiveKind::kCone) continue;
          EXPECT_TRUE(listed && surface_overlaps(scene, id, box, 3.0 * overlap_tolerance(scene)))
              << "primitive " << id << " voxel " << voxel;
        }
      }
    }
  }
}

TEST(VoxelGrid, NumbersItsVoxelsAndFindsThemAgain) {
  const CellGrid grid =
      grid::make_voxel_grid(scenes::load_scene("escena1"), with_resolution(3, 5, 4));
  EXPECT_EQ(grid::voxel_count(grid), 60U);
  for (std::size_t voxel = 0; voxel < grid::voxel_count(grid); ++voxel) {
    EXPECT_EQ(grid::voxel_index(grid, grid::voxel_at(grid, voxel)), voxel);
  }
}

TEST(VoxelGrid, VoxelsFollowEachOtherAndTouch) {
  const scenes::Scene scene = scenes::load_scene("escena1");
  const auto grid = build("voxel-grid:resolution=9x17x33", scene);
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const auto steps = grid->inspector()->path(tests::random_ray(scene, random));
    for (std::size_t k = 1; k < steps.size(); ++k) {
      EXPECT_EQ(steps[k].t_enter, std::max(steps[k - 1].t_exit, steps[0].t_enter));
      int moved = 0;
      for (int axis = 0; axis < 3; ++axis) {
        if (steps[k].box->lower[axis] == steps[k - 1].box->lower[axis]) continue;
        EXPECT_TRUE(steps[k].box->lower[axis] == steps[k - 1].box->upper[axis] ||
                    steps[k].box->upper[axis] == steps[k - 1].box->lower[axis]);
        ++moved;
      }
      EXPECT_EQ(moved, 1);
    }
  }
}

TEST(VoxelGrid, LazyEvaluatesOnlyWhatRaysVisit) {
  const scenes::Scene scene = scenes::load_scene("escena1");
  const auto lazy = build("voxel-grid:resolution=16,fill=lazy", scene);
  EXPECT_EQ(more(lazy->statistics(), "evaluated_voxels"), 0.0);
  EXPECT_EQ(lazy->statistics().references, 0U);

  const Ray ray = PrimaryRays(scene.cameras.front(), 64, 64, 1).ray(31, 33, 0);
  const auto visited = static_cast<double>(lazy->inspector()->path(ray).size());
  EXPECT_EQ(more(lazy->statistics(), "evaluated_voxels"), visited);
  EXPECT_EQ(more(lazy->statistics(), "evaluated_share"), visited / 4096.0);
  lazy->closest_hit(ray, nullptr);
  EXPECT_EQ(more(lazy->statistics(), "evaluated_voxels"), visited)
      << "each voxel is evaluated only once";
}

TEST(VoxelGrid, LazyAndEagerDoTheSameWork) {
  for (const char* name : {"tetra:n=4", "balls:n=2", "escena1"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    const PrimaryRays rays(scene.cameras.front(), 64, 64, 1);
    const auto count = [&](const char* spec) {
      HitBuffer buffer(64, 64, 1);
      WorkCounters counters;
      build(spec, scene)->closest_hits(rays, buffer, {&counters});
      return counters.by_name();
    };
    EXPECT_EQ(count("voxel-grid:fill=lazy"), count("voxel-grid:fill=eager"));
  }
}

TEST(VoxelGrid, LazyIsCorrectOnManyThreadsAtOnce) {
  for (const std::uint64_t seed : {3U, 4U, 5U, 6U}) {
    const scenes::Scene scene = tests::random_scene(seed, 60);
    const exhaustive::Exhaustive exhaustive(scene);
    std::vector<Ray> rays;
    std::vector<std::optional<Hit>> expected;
    Random random(seed);
    for (int i = 0; i < 2000; ++i) {
      rays.push_back(tests::random_ray(scene, random));
      expected.push_back(exhaustive.closest_hit(rays.back(), nullptr));
    }
    const grid::VoxelGrid<grid::LazyVoxels, grid::Mailboxes> grid(scene,
                                                                  with_resolution(12, 12, 12));
    // All threads query all rays: the same voxels are needed at the same time.
    std::vector<std::vector<std::optional<Hit>>> found(4);
    {
      std::vector<std::jthread> threads;
      threads.reserve(found.size());
      for (auto& mine : found) {
        threads.emplace_back([&] {
          for (const Ray& ray : rays) mine.push_back(grid.closest_hit(ray, nullptr));
        });
      }
    }
    for (const auto& each : found) EXPECT_EQ(each, expected);
    const grid::EagerVoxels eager(scene, grid.grid(), kNoCap);
    for (std::size_t voxel = 0; voxel < grid::voxel_count(grid.grid()); ++voxel) {
      EXPECT_GE(grid.voxels().references(voxel).size(), eager.references(voxel).size());
    }
  }
}

TEST(VoxelGrid, MailboxesSaveTestsButLoseNoHit) {
  const scenes::Scene scene = scenes::load_scene("balls:n=2");
  const PrimaryRays rays(scene.cameras.front(), 64, 64, 1);
  HitBuffer with(64, 64, 1);
  HitBuffer without(64, 64, 1);
  WorkCounters saved;
  WorkCounters all;
  build("voxel-grid:resolution=20,mailboxes=true", scene)->closest_hits(rays, with, {&saved});
  build("voxel-grid:resolution=20", scene)->closest_hits(rays, without, {&all});
  EXPECT_EQ(with, without);
  EXPECT_EQ(saved.get(Counter::kTraversalSteps), all.get(Counter::kTraversalSteps));
  EXPECT_LT(saved.get(Counter::kPrimitiveTests), all.get(Counter::kPrimitiveTests));
}

TEST(VoxelGrid, MailboxesAreFirstForEachPrimitiveOncePerRay) {
  for (int ray = 0; ray < 3; ++ray) {
    grid::Mailboxes boxes(10);
    EXPECT_TRUE(boxes.is_first(7));
    EXPECT_FALSE(boxes.is_first(7));
    EXPECT_TRUE(boxes.is_first(8));
  }
  grid::Mailboxes larger(1000);  // of another scene
  EXPECT_TRUE(larger.is_first(7));
  EXPECT_TRUE(larger.is_first(999));
}

TEST(VoxelGrid, AutomaticVoxelsAreCubesByDensity) {
  scenes::SceneBuilder builder("slab");
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    builder.add_sphere(
        {random.uniform(0.0, 80.0), random.uniform(0.0, 40.0), random.uniform(0.0, 10.0)}, 0.01);
  }
  const scenes::Scene scene = std::move(builder).build();
  grid::VoxelGridOptions options;
  options.density = 4.0;
  const CellGrid grid = grid::make_voxel_grid(scene, options);
  EXPECT_NEAR(grid.cells.x, 40, 1);  // 4,000 voxels of edge 2
  EXPECT_NEAR(grid.cells.y, 20, 1);
  EXPECT_NEAR(grid.cells.z, 5, 1);
}

TEST(VoxelGrid, AFlatSceneHasOneLayerOfVoxels) {
  scenes::SceneBuilder builder("floor");
  for (int i = 0; i < 100; ++i) {
    const std::vector<glm::dvec3> corners{
        {i, 0.0, 1.0}, {i + 1.0, 0.0, 1.0}, {i + 1.0, 100.0, 1.0}};
    builder.add_polygon(corners);
  }
  const scenes::Scene scene = std::move(builder).build();
  grid::VoxelGridOptions options;
  options.density = 9.0;
  EXPECT_EQ(grid::make_voxel_grid(scene, options).cells, glm::ivec3(30, 30, 1));
}

TEST(VoxelGrid, AutomaticVoxelsAreFewerForACluster) {
  scenes::SceneBuilder builder("heap");
  for (int i = 0; i < 2'000; ++i) builder.add_sphere({0.0, 0.0, 0.0}, 1.0);
  const scenes::Scene scene = std::move(builder).build();
  EXPECT_LE(build("voxel-grid:max_references=100000", scene)->statistics().references, 100'000U);
}

TEST(VoxelGrid, RefusesAGridThatIsTooLargeBeforeItIsMade) {
  const scenes::Scene scene = scenes::load_scene("escena1");
  const std::string voxels = refusal("voxel-grid:resolution=4096", scene);
  for (const char* word : {"4096x4096x4096", "68719476736 voxels", "max_voxels", "resolution"}) {
    EXPECT_NE(voxels.find(word), std::string::npos) << word << " in: " << voxels;
  }
  const std::string references =
      refusal("voxel-grid:resolution=30x20x10,max_references=1000", scene);
  for (const char* word : {"30x20x10", "escena1", "more than 1000", "max_references"}) {
    EXPECT_NE(references.find(word), std::string::npos) << word << " in: " << references;
  }
  EXPECT_NE(refusal("voxel-grid:resolution=4097", scene).find("from 1 to 4096"), std::string::npos);
}

TEST(VoxelGrid, LazyListsHaveTheSameCap) {
  const scenes::Scene scene = scenes::load_scene("escena1");
  const auto lazy = build("voxel-grid:resolution=30,fill=lazy,max_references=10", scene);
  HitBuffer buffer(32, 32, 1);
  EXPECT_THROW(lazy->closest_hits(PrimaryRays(scene.cameras.front(), 32, 32, 1), buffer, {}),
               InputError);
}

TEST(VoxelGrid, ReportsItsSizes) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=4");
  const Statistics eager = build("voxel-grid:resolution=10x20x30", scene)->statistics();
  EXPECT_EQ(eager.leaves, 6000U);
  EXPECT_GT(eager.empty_leaves, 3000U);
  EXPECT_GT(eager.references, 256U);
  EXPECT_GE(eager.bytes, 4 * (eager.leaves + eager.references));
  EXPECT_LE(eager.bytes, 4 * (eager.leaves + eager.references) + 1000);
}

}  // namespace
}  // namespace beambench::accel

// Beams through a hierarchy of grids: each sample belongs to one beam, and its hit is that of
// exhaustive search.

#include "accel/grid_beam/grid_beam.hpp"

#include <array>
#include <cstdint>

#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "tests/painted_once.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

using grid_beam::GridBeam;
using grid_beam::GridBeamOptions;
using hierarchical_grid::HierarchicalGridOptions;

/// Traces an image and checks that each sample belongs to one beam.
void expect_painted_once(const scenes::Scene& scene, const GridBeamOptions& options,
                         const PrimaryRays& rays) {
  const GridBeam tracer(scene, options);
  const auto meets_grid = [&](const Ray& ray) {
    return CellRay(tracer.lattice().cells(), ray).enter(0.0F) < double{kInfinity};
  };
  tests::expect_painted_once(scene, tracer, meets_grid, rays);
}

GridBeamOptions random_grid_options(Random& random) {
  GridBeamOptions options;
  options.grid.inner = HierarchicalGridOptions::Inner::kPowers;
  const auto cells = [&] { return 1 + static_cast<std::int32_t>(random.below(6)); };
  if (random.below(4) != 0) options.grid.resolution = {cells(), cells(), cells()};
  options.grid.inner_density = random.below(2) == 0 ? 6.0 : 1.0;
  options.grid.max_objects = static_cast<std::uint32_t>(random.below(3));
  options.grid.max_level = 1 + static_cast<int>(random.below(4));
  if (random.below(2) == 0) options.grid.divide = HierarchicalGridOptions::Divide::kAlways;
  if (random.below(3) == 0) options.rules.handover = static_cast<std::int64_t>(random.below(40));
  options.rules.continue_with_rays = random.below(3) != 0;
  options.rules.share_corners = random.below(2) == 0;
  options.rules.leaf = std::array{beam::LeafTest::kSimd, beam::LeafTest::kScalar,
                                  beam::LeafTest::kExact}[random.below(3)];
  return options;
}

TEST(GridBeam, PaintsEverySampleOfRandomScenesOnce) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const scenes::Scene scene = tests::random_scene(seed, static_cast<int>(1 + random.below(60)));
    const GridBeamOptions options = random_grid_options(random);
    const PrimaryRays rays(
        tests::random_camera(scene, random), 1 + static_cast<int>(random.below(40)),
        1 + static_cast<int>(random.below(40)), std::array{1, 4, 5}[random.below(3)]);
    expect_painted_once(scene, options, rays);
  }
}

// The planes of grids of all levels must have indices in one lattice.
TEST(GridBeam, TheLatticeHasThePlanesOfAllGrids) {
  GridBeamOptions options;
  options.grid.inner = HierarchicalGridOptions::Inner::kPowers;
  options.grid.resolution = {3, 5, 4};
  options.grid.divide = HierarchicalGridOptions::Divide::kAlways;
  options.grid.max_objects = 1;
  options.grid.max_level = 4;
  const scenes::Scene scene = scenes::load_scene("tetra:n=4");
  const GridBeam tracer(scene, options);
  const auto grids = tracer.hierarchy().grids();
  ASSERT_GT(grids.size(), 20U);
  for (std::uint32_t number = 0; number < grids.size(); ++number) {
    const CellGrid& grid = grids[number].place();
    const grid_beam::GridPlace& place = tracer.lattice().place(number);
    for (int axis = 0; axis < 3; ++axis) {
      for (std::int32_t i = 0; i <= grid.cells[axis]; ++i) {
        EXPECT_NEAR(grid.plane(axis, i),
                    tracer.lattice().cells().plane(axis, place.corner[axis] + place.size * i),
                    1e-12);
      }
    }
  }
}

TEST(GridBeam, HandsBeamsOverAndCountsThem) {
  const scenes::Scene scene = scenes::load_scene("escena2");
  const PrimaryRays rays(scene.cameras.front(), 128, 96, 1);
  const auto count = [&](const char* spec) {
    HitBuffer buffer(128, 96, 1);
    WorkCounters counters;
    const auto structure = registry().choose(parse_spec(spec)).build(scene);
    structure->closest_hits(rays, buffer, {&counters});
    EXPECT_FALSE(structure->inspector()->beams(rays).value().empty());
    return counters.by_name();
  };
  auto beams = count("grid-beam:handover=0");
  auto mixed = count("grid-beam:handover=64");
  auto rays_only = count("grid-beam:handover=1000000");
  EXPECT_EQ(beams["rays_by_handover"], 0U);
  EXPECT_GT(mixed["rays_by_handover"], 0U);
  EXPECT_LT(mixed["beams"], beams["beams"]);
  EXPECT_GT(rays_only["rays_by_handover"], mixed["rays_by_handover"]);
  EXPECT_EQ(beams["beams"],
            beams["beams_nonterminal"] + beams["beams_occupied"] + beams["beams_leaving"]);
  EXPECT_EQ(beams["beams_nonterminal"], beams["beams_divided"] + beams["beams_passed_whole"]);
}

}  // namespace
}  // namespace beambench::accel

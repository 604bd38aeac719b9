// Beams through a hierarchy of grids: each sample belongs to one beam, and its hit is that of
// exhaustive search.

#include "accel/grid_beam/grid_beam.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "accel/beam/beam_watch.hpp"
#include "accel/core/registry.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/core/random.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

using grid_beam::GridBeam;
using grid_beam::GridBeamOptions;
using hierarchical_grid::HierarchicalGridOptions;

/// Counts how often each sample is traced.
class PaintWatch : public beam::NoBeamWatch {
 public:
  static constexpr bool kPaintsLeaving = true;
  explicit PaintWatch(std::size_t places) : painted_(places, 0) {}
  void painted(std::size_t index) { ++painted_[index]; }
  void handed_over(beam::RayReason reason) {
    if (reason == beam::RayReason::kCrowded) ++crowded_;
  }

  std::uint8_t times(std::size_t index) const { return painted_[index]; }
  std::uint64_t crowded() const { return crowded_; }

 private:
  std::vector<std::uint8_t> painted_;
  std::uint64_t crowded_ = 0;
};

void expect_painted_once(const scenes::Scene& scene, const GridBeamOptions& options,
                         const PrimaryRays& rays) {
  const GridBeam tracer(scene, options);
  const exhaustive::Exhaustive exhaustive(scene);
  HitBuffer buffer(rays.width(), rays.height(), rays.samples());
  PaintWatch watch(buffer.size());
  tracer.trace_watched(rays, buffer, watch);
  std::size_t wrong_paint = 0;
  std::size_t wrong_hits = 0;
  std::string first;
  for (int y = 0; y < rays.height(); ++y) {
    for (int x = 0; x < rays.width(); ++x) {
      for (int sample = 0; sample < rays.samples(); ++sample) {
        const std::size_t index = buffer.index(x, y, sample);
        const Ray ray = rays.ray(x, y, sample);
        const bool meets = CellRay(tracer.lattice().cells(), ray).enter(0.0F) < double{kInfinity};
        const bool paint_is_wrong = watch.times(index) != (meets ? 1 : 0);
        const bool hit_is_wrong = buffer.get(index) != exhaustive.closest_hit(ray, nullptr);
        if (paint_is_wrong) ++wrong_paint;
        if (hit_is_wrong) ++wrong_hits;
        if ((paint_is_wrong || hit_is_wrong) && first.empty()) {
          first = fmt::format("first at ({}, {}) sample {}, painted {} times", x, y, sample,
                              watch.times(index));
        }
      }
    }
  }
  EXPECT_EQ(wrong_paint, 0U) << first;
  EXPECT_EQ(wrong_hits, 0U) << first;
  EXPECT_EQ(watch.crowded(), 0U);
}

GridBeamOptions random_options(Random& random) {
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
  return options;
}

/// A camera outside, inside or in the middle planes of the scene's box, in a random direction.
scenes::Camera random_camera(const scenes::Scene& scene, Random& random) {
  const glm::vec3 middle = 0.5F * (scene.bounds.lower + scene.bounds.upper);
  const glm::vec3 size = scene.bounds.upper - scene.bounds.lower;
  const float reach = std::max({size.x, size.y, size.z, 1e-3F});
  const float spread = random.below(2) == 0 ? 0.4F : 2.5F;
  scenes::Camera camera;
  for (int axis = 0; axis < 3; ++axis) {
    camera.from[axis] = middle[axis];
    if (random.below(4) != 0) {
      camera.from[axis] += reach * static_cast<float>(random.uniform(-spread, spread));
    }
    camera.at[axis] = middle[axis];
    if (random.below(4) != 0) {
      camera.at[axis] += reach * static_cast<float>(random.uniform(-0.5, 0.5));
    }
  }
  if (camera.from == camera.at) camera.at.x += reach;
  const glm::vec3 view = camera.at - camera.from;
  camera.up = {0.0F, 1.0F, 0.0F};
  if (std::abs(view.x) + std::abs(view.z) < 1e-3F * std::abs(view.y)) {
    camera.up = {0.0F, 0.0F, 1.0F};
  }
  camera.angle = std::array{5.0F, 45.0F, 90.0F, 170.0F}[random.below(4)];
  camera.aspect = std::array{1.0F, 1.6F, 0.4F}[random.below(3)];
  return camera;
}

TEST(GridBeam, PaintsEverySampleOfRandomScenesOnce) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const scenes::Scene scene = testing::random_scene(seed, static_cast<int>(1 + random.below(60)));
    const GridBeamOptions options = random_options(random);
    const PrimaryRays rays(random_camera(scene, random), 1 + static_cast<int>(random.below(40)),
                           1 + static_cast<int>(random.below(40)),
                           std::array{1, 4, 5}[random.below(3)]);
    expect_painted_once(scene, options, rays);
  }
}

// Planes of grids of all levels must have the numbers of one lattice.
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
    structure->trace(rays, buffer, &counters);
    EXPECT_FALSE(structure->beam_outlines(rays).empty());
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

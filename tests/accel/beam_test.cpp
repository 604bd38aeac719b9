// Properties of beams: every sample belongs to exactly one beam, however beams are divided.

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "accel/beam/beam_tracer.hpp"
#include "accel/core/registry.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/painted_once.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

using tests::random_scene;

/// Returns whether the ray of a sample passes through the root cell.
bool meets_root(const beam::BeamTracer& tracer, const Ray& ray) {
  return CellRay(tracer.octree().grid(), ray).enter(0.0F) < std::numeric_limits<double>::infinity();
}

/// Traces an image and checks that each sample belongs to one beam.
void expect_painted_once(const scenes::Scene& scene, const beam::BeamOptions& options,
                         const PrimaryRays& rays, std::size_t stride = 1) {
  const beam::BeamTracer tracer(scene, options);
  const auto watch = tests::expect_painted_once(
      scene, tracer, [&](const Ray& ray) { return meets_root(tracer, ray); }, rays, stride);
  if (options.handover == 0) {
    EXPECT_EQ(watch.rays_by(beam::RayReason::kHandover), 0U);
  }
}

beam::BeamOptions options_with(int max_level, std::uint32_t max_objects = 0) {
  beam::BeamOptions options;
  options.octree.max_level = max_level;
  options.octree.max_objects = max_objects;
  return options;
}

beam::BeamOptions random_beam_options(Random& random) {
  beam::BeamOptions options = options_with(1 + static_cast<int>(random.below(6)),
                                           static_cast<std::uint32_t>(random.below(3)));
  options.octree.root =
      random.below(2) == 0 ? octree::OctreeOptions::Root::kCube : octree::OctreeOptions::Root::kBox;
  if (random.below(3) == 0) options.handover = static_cast<std::int64_t>(random.below(40));
  options.continue_with_rays = random.below(3) != 0;
  options.share_corners = random.below(2) == 0;
  options.leaf = std::array{beam::LeafTest::kSimd, beam::LeafTest::kScalar,
                            beam::LeafTest::kExact}[random.below(3)];
  return options;
}

TEST(Beam, PaintsEverySampleOfRandomScenesOnce) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    const scenes::Scene scene = verify::random_scene(seed, static_cast<int>(1 + random.below(60)));
    const beam::BeamOptions options = random_beam_options(random);
    const PrimaryRays rays(
        tests::random_camera(scene, random), 1 + static_cast<int>(random.below(40)),
        1 + static_cast<int>(random.below(40)), std::array{1, 4, 5}[random.below(3)]);
    SCOPED_TRACE(fmt::format("seed {}", seed));
    expect_painted_once(scene, options, rays);
    if (HasFailure()) return;
  }
}

/// Returns the faces of a block of 4x4x4 cubes over [0, 8]^3. With a margin of an eighth, the root
/// is [-1, 9]^3 and the planes of its cells are floats, so that eyes can be placed on them.
scenes::Scene lattice_scene() {
  scenes::SceneBuilder builder("lattice");
  for (int cell = 0; cell < 64; ++cell) {
    const glm::dvec3 lower(2 * (cell & 3), 2 * (cell >> 2 & 3), 2 * (cell >> 4));
    if ((cell * 7) % 5 > 1) continue;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<glm::dvec3> corners(4, lower);
      corners[1][(axis + 1) % 3] += 2.0;
      corners[2][(axis + 1) % 3] += 2.0;
      corners[2][(axis + 2) % 3] += 2.0;
      corners[3][(axis + 2) % 3] += 2.0;
      builder.add_polygon(corners);
    }
  }
  builder.add_sphere({0.0, 0.0, 0.0}, 0.001);
  builder.add_sphere({8.0, 8.0, 8.0}, 0.001);
  return std::move(builder).build();
}

class EyeOnPlanes : public ::testing::TestWithParam<double> {};  // the root's margin

TEST_P(EyeOnPlanes, KeepsEverySampleAtFacesEdgesAndCorners) {
  const scenes::Scene scene = lattice_scene();
  beam::BeamOptions options = options_with(5);
  options.octree.pad = GetParam();
  // Faces, edges and corners of cells of all sizes, outside and inside, and points next to them.
  constexpr std::array kPlaces{-6.0F, -1.0F, 0.25F, 1.5F, 4.0F, 4.625F, 6.3F, 9.0F, 14.0F};
  const std::array<glm::vec3, 7> directions{
      {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {1, 1, 1}, {-1, 1, 0}, {-1, -1, -1}, {0.3F, -0.7F, 0.2F}}};
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    scenes::Camera camera;
    for (int axis = 0; axis < 3; ++axis) camera.from[axis] = kPlaces[random.below(9)];
    const glm::vec3 direction = directions[static_cast<std::size_t>(i) % directions.size()];
    camera.at = random.below(3) == 0 ? glm::vec3(4.0F) : camera.from + direction;
    if (camera.at == camera.from) camera.at = camera.from + direction;
    camera.up = {0.0F, 0.0F, 1.0F};
    const glm::vec3 look = camera.at - camera.from;
    if (look.x == 0.0F && look.y == 0.0F) camera.up = {0.0F, 1.0F, 0.0F};
    camera.angle = std::array{45.0F, 90.0F, 170.0F}[random.below(3)];
    camera.aspect = std::array{1.0F, 2.0F}[random.below(2)];
    // With odd sizes, samples lie on the view axis; with five samples per pixel, also on pixel
    // borders.
    const int size = std::array{1, 16, 17}[random.below(3)];
    SCOPED_TRACE(fmt::format("camera {}: from ({}, {}, {}) at ({}, {}, {}), {} degrees, {}", i,
                             camera.from.x, camera.from.y, camera.from.z, camera.at.x, camera.at.y,
                             camera.at.z, camera.angle, size));
    expect_painted_once(scene, options, PrimaryRays(camera, size, size, i % 2 == 0 ? 1 : 5));
    if (HasFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Margins, EyeOnPlanes, ::testing::Values(0.125, 1e-6, 0.0));

TEST(Beam, PaintsLargeImagesOnce) {
  const scenes::Scene scene = scenes::load_scene("escena2");
  expect_painted_once(scene, options_with(6), PrimaryRays(scene.cameras.front(), 4096, 4096, 1),
                      100'003);
  const scenes::Scene tetra = scenes::load_scene("tetra:n=4");
  expect_painted_once(tetra, options_with(6), PrimaryRays(tetra.cameras.front(), 1920, 333, 5),
                      10'007);
}

std::map<std::string, std::uint64_t, std::less<>> counters_of(const scenes::Scene& scene,
                                                              const beam::BeamOptions& options,
                                                              const PrimaryRays& rays) {
  const beam::BeamTracer tracer(scene, options);
  HitBuffer buffer(rays.width(), rays.height(), rays.samples());
  WorkCounters counters;
  tracer.closest_hits(rays, buffer, {&counters});
  return counters.by_name();
}

TEST(Beam, CreatesTheSameBeamsAtEveryResolution) {
  for (const char* name : {"tetra:n=5", "escena1", "escena2", "bumpy:triangles=768"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    const scenes::Camera& camera = scene.cameras.front();
    const auto expected = counters_of(scene, options_with(6), PrimaryRays(camera, 320, 200, 1));
    for (const auto& rays : {PrimaryRays(camera, 1, 1, 1), PrimaryRays(camera, 77, 1024, 1),
                             PrimaryRays(camera, 640, 480, 5)}) {
      const auto counters = counters_of(scene, options_with(6), rays);
      for (const char* counter : {"beams", "beams_nonterminal", "beams_occupied", "beams_leaving",
                                  "beams_made", "beams_divided", "beams_passed_whole", "beam_edges",
                                  "beam_clips", "neighbor_searches"}) {
        EXPECT_EQ(counters.at(counter), expected.at(counter)) << counter;
        EXPECT_GT(counters.at(counter), 0U) << counter;
      }
    }
  }
}

/// Every beam ends: it is divided, reaches an occupied leaf, or leaves the root.
TEST(Beam, CountsABeamWhenItIsCreated) {
  for (const char* name : {"tetra:n=5", "escena1", "escena2", "habitacion", "closed-room"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    const PrimaryRays rays(scene.cameras.front(), 16, 16, 1);
    const auto beams = counters_of(scene, options_with(6), rays);
    EXPECT_EQ(beams.at("beams_made"),
              beams.at("beams_divided") + beams.at("beams_occupied") + beams.at("beams_leaving"));
    EXPECT_EQ(beams.at("beams_nonterminal"),
              beams.at("beams_divided") + beams.at("beams_passed_whole"));
    EXPECT_GE(beams.at("beams"), beams.at("beams_made"));
    // A division yields at least two beams, and all beams except the first come from one.
    EXPECT_GT(beams.at("beams_made"), 2 * beams.at("beams_divided"));
  }
}

// The thesis prints 8,701 and 4,071 beams for level 6, 37,718 and 17,751 for level 7 (5.3.3).
TEST(Beam, CountsTheBeamsOfMaceta) {
  struct Counts {
    int level;
    std::uint64_t entered, nonterminal, made, divided, passed_whole;
  };
  const scenes::Scene scene = scenes::load_scene("maceta");
  const PrimaryRays rays(scene.cameras.front(), 16, 16, 1);
  for (const Counts& expected : {Counts{6, 118'818, 96'586, 40'646, 18'414, 78'172},
                                 Counts{7, 737'004, 631'341, 196'561, 90'898, 540'443}}) {
    SCOPED_TRACE(expected.level);
    const auto beams = counters_of(scene, options_with(expected.level), rays);
    EXPECT_EQ(beams.at("beams"), expected.entered);
    EXPECT_EQ(beams.at("beams_nonterminal"), expected.nonterminal);
    EXPECT_EQ(beams.at("beams_made"), expected.made);
    EXPECT_EQ(beams.at("beams_divided"), expected.divided);
    EXPECT_EQ(beams.at("beams_passed_whole"), expected.passed_whole);
  }
}

TEST(Beam, CountsTheSameOnSeveralThreads) {
  const scenes::Scene scene = scenes::load_scene("escena1");
  const PrimaryRays rays(scene.cameras.front(), 64, 48, 1);
  const auto alone = counters_of(scene, options_with(6), rays);
  const beam::BeamTracer tracer(scene, options_with(6));
  HitBuffer buffer(rays.width(), rays.height(), rays.samples());
  WorkCounters counters;
  tracer.closest_hits(rays, buffer, {&counters, 2});
  const auto shared = counters.by_name();
  for (const char* counter : {"beams", "beams_made", "beams_divided", "beams_passed_whole"}) {
    EXPECT_EQ(shared.at(counter), alone.at(counter)) << counter;
  }
}

TEST(Beam, CreatesRaysOnlyBehindOccupiedLeaves) {
  const scenes::Scene scene = scenes::load_scene("escena1");
  const PrimaryRays rays(scene.cameras.front(), 160, 100, 1);
  const auto counters = counters_of(scene, options_with(6), rays);
  EXPECT_EQ(counters.at("rays_by_handover"), 0U);
  EXPECT_EQ(counters.at("rays_by_crowding"), 0U);
  EXPECT_GT(counters.at("rays_after_leaf"), 0U);
  EXPECT_LE(counters.at("rays_after_leaf"), counters.at("samples_in_leaves"));
  // Samples that leave with a beam cost neither a ray nor a test.
  EXPECT_GT(counters.at("samples_leaving"), 0U);
  EXPECT_LE(counters.at("samples_leaving") + counters.at("samples_in_leaves"), rays.count());

  beam::BeamOptions handing = options_with(6);
  handing.handover = 30;
  const auto handed = counters_of(scene, handing, rays);
  EXPECT_GT(handed.at("rays_by_handover"), 0U);
  EXPECT_LT(handed.at("beams"), counters.at("beams"));
}

TEST(Beam, SharesCornersBetweenPixels) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=4");
  const PrimaryRays rays(scene.cameras.front(), 64, 48, 5);
  beam::BeamOptions shared = options_with(5);
  shared.share_corners = true;
  const auto apart = counters_of(scene, options_with(5), rays);
  const auto together = counters_of(scene, shared, rays);
  // (w + 1)(h + 1) corners instead of 4 w h.
  EXPECT_LT(together.at("samples_in_leaves") * 2, apart.at("samples_in_leaves"));
  expect_painted_once(scene, shared, rays);
}

TEST(Beam, ContinuesBehindOccupiedLeavesOnRequest) {
  const scenes::Scene scene = scenes::load_scene("escena1");
  const PrimaryRays rays(scene.cameras.front(), 160, 100, 1);
  beam::BeamOptions beams = options_with(6);
  beams.continue_with_rays = false;
  const auto counters = counters_of(scene, beams, rays);
  EXPECT_EQ(counters.at("rays_after_leaf"), 0U);
  EXPECT_GT(counters.at("beams"), counters_of(scene, options_with(6), rays).at("beams"));
}

TEST(Beam, ShowsTheOutlinesOfItsBeams) {
  const scenes::Scene scene = scenes::load_scene("escena2");
  const PrimaryRays rays(scene.cameras.front(), 64, 48, 1);
  const beam::BeamTracer tracer(scene, options_with(5));
  const auto outlines = tracer.beams(rays).value();
  EXPECT_EQ(outlines.size(), counters_of(scene, options_with(5), rays).at("beams"));
  for (const BeamOutline& outline : outlines) {
    ASSERT_GE(outline.corners.size(), 1U);
    for (const glm::dvec2& corner : outline.corners) {
      EXPECT_GE(corner.x, -0.01);
      EXPECT_LE(corner.x, 64.01);
      EXPECT_GE(corner.y, -0.01);
      EXPECT_LE(corner.y, 48.01);
    }
  }
}

}  // namespace
}  // namespace beambench::accel

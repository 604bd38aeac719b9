// Beams of reflected rays find what single rays of the virtual eye find, and these are reflected
// rays.

#include "accel/beam/mirror_beams.hpp"

#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "accel/core/primary_rays.hpp"
#include "accel/core/registry.hpp"
#include "scenes/catalogue.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

using glm::dvec3;

/// How much was compared.
struct Compared {
  std::size_t mirrors = 0;
  std::size_t samples = 0;
  std::size_t hits = 0;
};

/// Each sample by beams and by a single ray, bit for bit.
void compare(const scenes::Scene& scene, const beam::BeamOptions& options, const PrimaryRays& rays,
             Compared& compared) {
  const beam::BeamTracer tracer(scene, options);
  HitBuffer hits(rays.width(), rays.height(), rays.samples());
  tracer.trace(rays, hits, nullptr);
  const auto exhaustive = registry().choose({"exhaustive", {}}).build(scene);
  for (const scenes::PlanarMirror& mirror : scenes::planar_mirrors(scene)) {
    const auto view = beam::view_in(mirror, scene, rays, hits);
    if (!view) continue;
    ++compared.mirrors;
    HitBuffer found(rays.width(), rays.height(), rays.samples());
    tracer.trace_behind(view->sight, view->rays, found);
    std::size_t samples = 0;
    for (int y = 0; y < rays.height(); ++y) {
      for (int x = 0; x < rays.width(); ++x) {
        for (int sample = 0; sample < rays.samples(); ++sample) {
          const std::size_t index = found.index(x, y, sample);
          const scenes::PrimitiveId id = hits.primitive()[index];
          if (std::ranges::find(mirror.polygons, id) == mirror.polygons.end()) {
            ASSERT_FALSE(found.get(index)) << x << ", " << y;
            continue;
          }
          const auto expected =
              exhaustive->closest_hit(beam::ray_behind(*view, x, y, sample), nullptr);
          ASSERT_EQ(found.get(index), expected) << x << ", " << y;
          ++samples;
          compared.hits += expected ? 1 : 0;
        }
      }
    }
    EXPECT_EQ(samples, view->samples);
    compared.samples += samples;
  }
}

/// A random scene of mirrors.
scenes::Scene mirrors(std::uint64_t seed) {
  scenes::Scene scene = testing::random_scene(seed, 40);
  for (scenes::Surface& surface : scene.surfaces) surface.specular = 0.5F;
  return scene;
}

TEST(MirrorBeams, FindWhatSingleRaysFindInRandomScenes) {
  Compared compared;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = mirrors(seed);
    beam::BeamOptions options;
    options.octree.max_level = static_cast<int>(3 + seed % 3);
    options.continue_with_rays = seed % 2 == 0;
    options.handover = seed % 3 == 0 ? 6 : 0;
    compare(scene, options, PrimaryRays(scene.cameras.front(), 40, 30, 1), compared);
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(compared.mirrors, 100U);
  EXPECT_GT(compared.hits, 1000U);
}

TEST(MirrorBeams, FindWhatSingleRaysFindInScenes) {
  for (const char* name : {"teapot:n=2", "gears:n=1"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    Compared compared;
    beam::BeamOptions options;
    options.octree.max_level = 5;
    compare(scene, options, PrimaryRays(scene.cameras.front(), 60, 60, 1), compared);
    if (::testing::Test::HasFatalFailure()) return;
    EXPECT_GT(compared.samples, 200U);
    EXPECT_GT(compared.hits, 10U);
  }
}

TEST(MirrorBeams, RaysBehindAMirrorAreReflectedRays) {
  const scenes::Scene scene = scenes::load_scene("teapot:n=2");
  const PrimaryRays rays(scene.cameras.front(), 50, 50, 1);
  HitBuffer hits(50, 50, 1);
  registry().choose({"samet", {}}).build(scene)->trace(rays, hits, nullptr);
  const auto mirrors = scenes::planar_mirrors(scene);
  ASSERT_EQ(mirrors.size(), 1U);  // the checkerboard, all squares of it
  const auto view = beam::view_in(mirrors[0], scene, rays, hits);
  ASSERT_TRUE(view.has_value());
  const double size = scene.bounds.largest_coordinate();
  std::size_t compared = 0;
  for (int y = 0; y < 50; ++y) {
    for (int x = 0; x < 50; ++x) {
      const auto hit = hits.get(hits.index(x, y, 0));
      if (!hit ||
          std::ranges::find(mirrors[0].polygons, hit->primitive) == mirrors[0].polygons.end()) {
        continue;
      }
      const Ray eye = rays.ray(x, y, 0);
      const Ray behind = beam::ray_behind(*view, x, y, 0);
      const dvec3 point = dvec3(eye.origin) + double{hit->t} * dvec3(eye.direction);
      const dvec3 begin = dvec3(behind.origin) + double{behind.t_min} * dvec3(behind.direction);
      EXPECT_LT(glm::length(begin - point), 1e-4 * size);
      const dvec3 reflected = mirrored(dvec3(eye.direction), mirrors[0].normal);
      EXPECT_LT(glm::length(dvec3(behind.direction) - reflected), 1e-6);
      ++compared;
    }
  }
  EXPECT_EQ(compared, view->samples);
  EXPECT_GT(compared, 200U);
}

}  // namespace
}  // namespace beambench::accel

// Beams of reflected rays find what single rays find, and the rays that mirrors send on are
// reflected rays.

#include "accel/beam/mirror_beams.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "accel/beam/beam_tracer.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/core/registry.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/planar_mirrors.hpp"
#include "tests/disturbed_rays.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

using glm::dvec3;

/// The rays that a mirror sends on, given rays that all seem to come from one point: a pencil.
struct Reflected {
  PrimaryRays image;
  dvec3 apex;
  std::vector<Ray> rays;
  std::vector<std::uint32_t> samples;

  Pencil pencil(std::size_t first = 0) const { return {first, rays.size(), apex, false, &image}; }
};

/// The rays of an image, none of them reflected yet.
Reflected seen_directly(const PrimaryRays& image) {
  Reflected seen{image, dvec3(image.eye()), {}, {}};
  image.for_each(0, image.height(), [&](std::size_t index, const Ray& ray) {
    seen.rays.push_back(ray);
    seen.samples.push_back(static_cast<std::uint32_t>(index));
  });
  return seen;
}

/// Returns the reflections of the rays that hit a mirror from one side.
Reflected reflected(const Reflected& from, const HitBuffer& hits,
                    const scenes::PlanarSurface& mirror, double side, double lift) {
  const dvec3 lifted = side * lift * mirror.normal;
  Reflected next{from.image.mirrored(mirror.point, mirror.normal),
                 mirror.point + mirrored(from.apex - mirror.point, mirror.normal) + lifted,
                 {},
                 {}};
  for (std::size_t i = 0; i < from.rays.size(); ++i) {
    const auto hit = hits.get(i);
    const dvec3 direction(from.rays[i].direction);
    if (!hit || side * glm::dot(direction, mirror.normal) >= 0.0) continue;
    if (std::ranges::find(mirror.polygons, hit->primitive) == mirror.polygons.end()) continue;
    Ray& ray = next.rays.emplace_back();
    ray.origin = glm::vec3(dvec3(from.rays[i].origin) + double{hit->t} * direction + lifted);
    ray.direction = glm::vec3(mirrored(direction, mirror.normal));
    next.samples.push_back(from.samples[i]);
  }
  return next;
}

/// Returns the same rays, turned and moved by up to a part of a pixel. This is far more than
/// rounding, so it reveals beams with too small a margin.
Reflected shaken(Reflected seen, double part, Random& random) {
  const double pixel = std::min(glm::length(seen.image.right()), glm::length(seen.image.down()));
  for (Ray& ray : seen.rays) {
    const double size = part * pixel * glm::length(dvec3(ray.origin) - seen.apex);
    ray.origin += glm::vec3(size * verify::point_in_cube(random));
    ray.direction += glm::vec3(part * pixel * verify::point_in_cube(random));
  }
  return seen;
}

/// The number of comparisons.
struct Compared {
  std::size_t pencils = 0;  ///< that were traced in beams
  std::size_t rays = 0;
  std::size_t hits = 0;
};

HitBuffer hits_of(const Accelerator& structure, const RayBatch& batch) {
  HitBuffer hits(static_cast<int>(batch.rays.size()), 1, 1);
  structure.closest_hits(batch, hits, {});
  return hits;
}

/// Compares each ray of all mirrors' pencils, traced in beams and singly, bit for bit; then those
/// of the mirrors that these see, `depth` in a row.
void compare(const scenes::Scene& scene, const beam::BeamTracer& tracer, const Reflected& from,
             int depth, double shake, Compared& compared) {
  Random random(1);
  const octree::Samet samet(scene, tracer.options().octree);
  const HitBuffer hits = hits_of(samet, {from.rays});
  const double lift = 0x1p-17 * scene.bounds.largest_coordinate();
  for (const scenes::PlanarSurface& mirror : scenes::planar_mirrors(scene)) {
    for (const double side : {1.0, -1.0}) {
      const Reflected seen = shaken(reflected(from, hits, mirror, side, lift), shake, random);
      if (seen.rays.empty()) continue;
      const Pencil pencil = seen.pencil();
      HitBuffer found(static_cast<int>(seen.rays.size()), 1, 1);
      WorkCounters counters;
      tracer.closest_hits(accel::RayBatch{seen.rays, {&pencil, 1}, seen.samples}, found,
                          {&counters});
      const HitBuffer expected = hits_of(samet, {seen.rays});
      ASSERT_EQ(found, expected);
      ASSERT_EQ(hits_of(tracer, {seen.rays, {&pencil, 1}, seen.samples}), expected);
      compared.pencils += counters.by_name().contains("beams") ? 1 : 0;
      compared.rays += seen.rays.size();
      for (std::size_t i = 0; i < found.size(); ++i) compared.hits += found.get(i) ? 1 : 0;
      if (depth > 1) compare(scene, tracer, seen, depth - 1, shake, compared);
      if (::testing::Test::HasFatalFailure()) return;
    }
  }
}

/// A random scene of mirrors.
scenes::Scene mirrors(std::uint64_t seed) {
  scenes::Scene scene = tests::random_scene(seed, 20);
  for (scenes::Surface& surface : scene.surfaces) surface.specular = 0.5F;
  return scene;
}

/// The scene's camera, or one in the middle planes of the scene. These are also planes of cells,
/// and then the virtual eyes of many mirrors lie in such planes, too.
scenes::Camera camera_of(const scenes::Scene& scene, Random& random) {
  scenes::Camera camera = scene.cameras.front();
  const glm::vec3 middle = 0.5F * (scene.bounds.lower + scene.bounds.upper);
  for (int axis = 0; axis < 3; ++axis) {
    if (random.below(3) == 0) camera.from[axis] = middle[axis];
  }
  if (camera.from == camera.at) return scene.cameras.front();
  const glm::vec3 view = glm::normalize(camera.at - camera.from);
  camera.up = std::abs(view.y) < 0.9F ? glm::vec3(0.0F, 1.0F, 0.0F) : glm::vec3(1.0F, 0.0F, 0.0F);
  camera.angle = std::array{20.0F, 60.0F, 120.0F}[random.below(3)];
  return camera;
}

TEST(MirrorBeams, FindWhatSingleRaysFindInRandomScenes) {
  Compared compared;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const scenes::Scene scene = mirrors(seed);
    beam::BeamOptions options;
    options.octree.max_level = static_cast<int>(3 + seed % 4);
    options.continue_with_rays = seed % 2 == 0;
    options.share_corners = seed % 5 == 0;
    options.handover = seed % 3 == 0 ? 20 : 0;
    options.leaf = std::array{beam::LeafTest::kSimd, beam::LeafTest::kScalar,
                              beam::LeafTest::kExact}[seed / 6 % 3];
    const PrimaryRays image(camera_of(scene, random), 120, 100, seed % 5 == 0 ? 5 : 1);
    compare(scene, beam::BeamTracer(scene, options), seen_directly(image), 2,
            seed % 2 == 0 ? 0.0 : 0.01, compared);
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(compared.pencils, 200U);
  EXPECT_GT(compared.rays, 100'000U);
  EXPECT_GT(compared.hits, 50'000U);
}

TEST(MirrorBeams, FindWhatSingleRaysFindInScenes) {
  for (const char* name : {"teapot:n=2", "gears:n=1", "closed-room"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    Compared compared;
    const PrimaryRays image(scene.cameras.front(), 56, 56, 1);
    compare(scene, beam::BeamTracer(scene, {}), seen_directly(image), 1, 0.0, compared);
    if (::testing::Test::HasFatalFailure()) return;
    EXPECT_GT(compared.pencils, 0U);
    EXPECT_GT(compared.hits, 100U);
  }
}

/// The floor of a scene and the rays that it reflects.
struct Floor {
  explicit Floor(const char* name)
      : scene(scenes::load_scene(name)),
        seen(seen_directly(PrimaryRays(scene.cameras.front(), 60, 60, 1))) {
    const HitBuffer hits = hits_of(octree::Samet(scene, {}), {seen.rays});
    const scenes::PlanarSurface mirror = scenes::planar_mirrors(scene).front();
    const double side = glm::dot(seen.apex - mirror.point, mirror.normal) > 0.0 ? 1.0 : -1.0;
    seen = reflected(seen, hits, mirror, side, 1e-4);
  }

  scenes::Scene scene;
  Reflected seen;
};

TEST(MirrorBeams, OtherRaysOfABatchAreTracedSingly) {
  const Floor floor("teapot:n=2");
  const std::size_t third = floor.seen.rays.size() / 3;
  Pencil left = floor.seen.pencil();
  left.count = third;
  Pencil right = floor.seen.pencil(2 * third);
  right.count = third;
  Pencil toward{third, third, dvec3(1.0, 2.0, 3.0), true};
  const beam::BeamTracer tracer(floor.scene, {});
  const HitBuffer expected = hits_of(tracer, {floor.seen.rays});
  const auto expect_same = [&](std::span<const Pencil> pencils) {
    EXPECT_EQ(hits_of(tracer, {floor.seen.rays, pencils, floor.seen.samples}), expected);
    EXPECT_EQ(hits_of(tracer, {floor.seen.rays, pencils}), expected);
  };
  expect_same(std::array{left, right});
  expect_same(std::array{left, toward, right});
  right.view = nullptr;
  expect_same(std::array{left, right});
  right = floor.seen.pencil(floor.seen.rays.size() - 20);
  right.count = 20;  // too few for beams
  expect_same(std::array{left, right});
}

TEST(MirrorBeams, RaysThatAreNotThoseOfTheirSamplesAreTracedSingly) {
  Floor floor("teapot:n=2");
  Random random(1);
  tests::disturb(floor.seen.rays, floor.seen.samples, 12, random);
  const beam::BeamTracer tracer(floor.scene, {});
  const Pencil pencil = floor.seen.pencil();
  EXPECT_EQ(hits_of(tracer, {floor.seen.rays, {&pencil, 1}, floor.seen.samples}),
            hits_of(tracer, {floor.seen.rays}));
}

TEST(MirrorBeams, MissWhereThereIsNothing) {
  const Floor floor("teapot:n=2");
  const scenes::Scene nothing;
  const Pencil pencil = floor.seen.pencil();
  const HitBuffer hits =
      hits_of(beam::BeamTracer(nothing, {}), {floor.seen.rays, {&pencil, 1}, floor.seen.samples});
  for (std::size_t i = 0; i < hits.size(); ++i) EXPECT_FALSE(hits.get(i));
}

TEST(MirrorBeams, TheirWorkIsUnchanged) {
  const Floor floor("teapot:n=2");
  const Pencil pencil = floor.seen.pencil();
  HitBuffer hits(static_cast<int>(floor.seen.rays.size()), 1, 1);
  WorkCounters counters;
  beam::BeamTracer(floor.scene, {})
      .closest_hits(accel::RayBatch{floor.seen.rays, {&pencil, 1}, floor.seen.samples}, hits,
                    {&counters});
  std::map<std::string, std::uint64_t> work;
  for (const auto& [name, count] : counters.by_name()) {
    if (count != 0 && !name.ends_with("_ns")) work[name] = count;
  }
  EXPECT_EQ(work["polygon_tests"], work["primitive_tests"]) << "there is nothing else";
  for (const std::string_view name : kTestNames) {
    work.erase(std::string(name));
  }
  // clang-format off
  const std::map<std::string, std::uint64_t> expected{
      {"beam_clips", 1802}, {"beam_edges", 4622}, {"beams", 1073}, {"beams_divided", 198},
      {"beams_leaving", 34}, {"beams_made", 1047}, {"beams_nonterminal", 976},
      {"beams_occupied", 63}, {"beams_passed_whole", 26}, {"empty_leaves", 5554},
      {"last_climb", 302}, {"leaves", 7354}, {"neighbor_searches", 456}, {"neighbor_steps", 23'814},
      {"primitive_tests", 4607}, {"rays_after_leaf", 74}, {"rays_by_handover", 1256},
      {"samples_in_leaves", 84}, {"samples_leaving", 164}, {"traversal_steps", 25'552}};
  // clang-format on
  EXPECT_EQ(work, expected);
}

TEST(MirrorBeams, RaysOfAMirrorAreReflectedRays) {
  const scenes::Scene scene = scenes::load_scene("teapot:n=2");
  const PrimaryRays rays(scene.cameras.front(), 50, 50, 1);
  HitBuffer hits(50, 50, 1);
  registry().choose({"samet", {}}).build(scene)->closest_hits(rays, hits, {});
  const auto mirrors = scenes::planar_mirrors(scene);
  ASSERT_EQ(mirrors.size(), 1U);  // the checkerboard, with all its squares
  const auto view = beam::view_in(mirrors[0], rays, hits);
  ASSERT_TRUE(view.has_value());
  EXPECT_GT(view->rays.size(), 200U);
  const double size = scene.bounds.largest_coordinate();
  for (std::size_t i = 0; i < view->rays.size(); ++i) {
    const int x = static_cast<int>(view->samples[i] % 50);
    const int y = static_cast<int>(view->samples[i] / 50);
    const auto hit = hits.get(view->samples[i]);
    ASSERT_TRUE(hit && std::ranges::find(mirrors[0].polygons, hit->primitive) !=
                           mirrors[0].polygons.end());
    const Ray eye = rays.ray(x, y, 0);
    const dvec3 point = dvec3(eye.origin) + double{hit->t} * dvec3(eye.direction);
    const dvec3 origin(view->rays[i].origin);
    const dvec3 direction(view->rays[i].direction);
    EXPECT_LT(glm::length(origin - point), 1e-4 * size);
    EXPECT_LT(glm::length(direction - mirrored(dvec3(eye.direction), mirrors[0].normal)), 1e-6);
    // As seen from the virtual eye.
    EXPECT_LT(glm::length(direction - dvec3(view->image.ray(x, y, 0).direction)), 1e-6);
    EXPECT_LT(glm::length(glm::cross(direction, origin - view->apex)), 1e-5 * size);
  }
}

}  // namespace
}  // namespace beambench::accel

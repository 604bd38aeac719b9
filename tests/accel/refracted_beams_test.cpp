// Beams of rays refracted by planes find what single rays find.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "accel/beam/beam_tracer.hpp"
#include "accel/beam/drifting_view.hpp"
#include "accel/core/cell_ray.hpp"
#include "accel/core/primary_rays.hpp"
#include "harness/render/shading.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/disturbed_rays.hpp"
#include "tests/number_from.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

using glm::dvec3;

struct Plane {
  dvec3 point;
  dvec3 normal;
};

/// The rays of an image after reflection or refraction by planes.
struct Rays {
  std::vector<Ray> rays;
  std::vector<std::uint32_t> samples;
};

Rays rays_of(const PrimaryRays& image) {
  Rays all;
  image.for_each(0, image.height(), [&](std::size_t index, const Ray& ray) {
    all.rays.push_back(ray);
    all.samples.push_back(static_cast<std::uint32_t>(index));
  });
  return all;
}

/// Returns the rays that cross a plane, refracted or, where `ratio` is 0, reflected.
Rays behind(const Plane& plane, double ratio, const Rays& from) {
  Rays next;
  for (std::size_t i = 0; i < from.rays.size(); ++i) {
    const dvec3 origin(from.rays[i].origin);
    const dvec3 direction = glm::normalize(dvec3(from.rays[i].direction));
    const double speed = glm::dot(direction, plane.normal);
    const double t = glm::dot(plane.point - origin, plane.normal) / speed;
    if (!(t > 1e-3 && t < 1e3)) continue;
    const dvec3 normal = speed < 0.0 ? plane.normal : -plane.normal;
    const auto turned = ratio == 0.0 ? std::optional(mirrored(direction, normal))
                                     : render::refracted(direction, normal, ratio);
    if (!turned) continue;
    Ray& ray = next.rays.emplace_back();
    ray.origin = glm::vec3(origin + t * direction + 1e-5 * *turned);
    ray.direction = glm::vec3(*turned);
    next.samples.push_back(from.samples[i]);
  }
  return next;
}

HitBuffer hits_of(const Accelerator& structure, const RayBatch& batch,
                  WorkCounters* counters = nullptr) {
  HitBuffer hits(static_cast<int>(batch.rays.size()), 1, 1);
  structure.closest_hits(batch, hits, {counters});
  return hits;
}

BatchMarks all_refracted(const Rays& rays) { return {{}, {{0, rays.rays.size()}}}; }

TEST(RefractedBeams, FindWhatSingleRaysFindInRandomScenes) {
  std::size_t rays = 0, hits = 0, in_beams = 0;
  const std::uint64_t seeds = tests::in_full(300, 50);
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const scenes::Scene scene = tests::random_scene(seed, 40);
    beam::BeamOptions options;
    options.octree.max_level = static_cast<int>(2 + seed % 5);
    options.continue_with_rays = seed % 2 == 0;
    options.handover = seed % 3 == 0 ? 20 : 0;
    options.leaf = std::array{beam::LeafTest::kSimd, beam::LeafTest::kScalar,
                              beam::LeafTest::kExact}[seed / 6 % 3];
    const beam::BeamTracer tracer(scene, options);
    const octree::Samet samet(scene, options.octree);
    scenes::Camera camera = scene.cameras.front();
    camera.angle = std::array{15.0F, 45.0F, 90.0F}[random.below(3)];
    const PrimaryRays image(camera, 120, 90, seed % 5 == 0 ? 4 : 1);
    // Three tilted planes between the camera and the center, each of which may reflect.
    Rays now = rays_of(image);
    for (int depth = 1; depth <= 3; ++depth) {
      const dvec3 normal = glm::normalize(dvec3(image.forward()) +
                                          random.uniform(0.0, 1.5) * verify::point_in_cube(random));
      const Plane plane{glm::mix(dvec3(camera.from), dvec3(camera.at), 0.2 * depth), normal};
      const double ratio = std::array{1.0 / 1.5, 1.0 / 1.33, 1.5, 0.0, 1.1}[random.below(5)];
      now = behind(plane, ratio, now);
      if (now.rays.empty()) break;
      const BatchMarks marks = all_refracted(now);
      const RayBatch batch{now.rays, {}, now.samples, &image, &marks};
      const HitBuffer expected = hits_of(samet, {now.rays});
      ASSERT_EQ(hits_of(tracer, batch), expected) << depth;
      WorkCounters counters;
      ASSERT_EQ(hits_of(tracer, batch, &counters), expected) << depth;
      rays += now.rays.size();
      const auto alone = tracer.traced_alone(batch);
      in_beams += static_cast<std::size_t>(std::ranges::count(alone, 0));
      for (std::size_t i = 0; i < expected.size(); ++i) hits += expected.get(i) ? 1 : 0;
    }
  }
  EXPECT_GT(rays, 300'000U);
  EXPECT_GT(hits, 30'000U);
  EXPECT_GT(in_beams, rays / 3);
}

/// A scene seen through a plane at some angle.
struct ThroughGlass {
  ThroughGlass(const scenes::Scene& scene, double degrees, int width)
      : image(scene.cameras.front(), width, width, 1) {
    const scenes::Camera& camera = scene.cameras.front();
    const double angle = degrees * 3.14159265358979323846 / 180.0;
    const dvec3 side = glm::normalize(image.across());
    seen = behind({glm::mix(dvec3(camera.from), dvec3(camera.at), 0.3),
                   std::cos(angle) * image.forward() + std::sin(angle) * side},
                  1.0 / 1.5, rays_of(image));
    marks = all_refracted(seen);
  }

  RayBatch batch() const { return {seen.rays, {}, seen.samples, &image, &marks}; }

  PrimaryRays image;
  Rays seen;
  BatchMarks marks;
};

// Seen from inside a room, no ray misses the scene.
TEST(RefractedBeams, LeaveFewRaysToSingleTracing) {
  const scenes::Scene scene = scenes::load_scene("closed-room:detail=2");
  const beam::BeamTracer tracer(scene, {});
  for (const auto& [degrees, most] : {std::pair(0.0, 0.01), {20.0, 0.02}, {40.0, 0.1}}) {
    const ThroughGlass glass(scene, degrees, 320);
    const auto alone = tracer.traced_alone(glass.batch());
    const auto count = static_cast<double>(std::accumulate(alone.begin(), alone.end(), 0));
    EXPECT_LE(count, most * static_cast<double>(alone.size())) << degrees;
    EXPECT_EQ(hits_of(tracer, glass.batch()), hits_of(tracer, {glass.seen.rays})) << degrees;
  }
}

TEST(RefractedBeams, RaysUnlikeTheirNeighborsAreTracedSingly) {
  const scenes::Scene scene = scenes::load_scene("teapot:n=3");
  ThroughGlass glass(scene, 10.0, 100);
  Random random(1);
  tests::disturb(glass.seen.rays, glass.seen.samples, 40, random);
  const beam::BeamTracer tracer(scene, {});
  EXPECT_EQ(hits_of(tracer, glass.batch()), hits_of(tracer, {glass.seen.rays}));
  EXPECT_GT(std::ranges::count(tracer.traced_alone(glass.batch()), 0), 100);
}

// A plane of cells passes next to the eye of the view, which drifts from one side of the plane to
// the other: samples on both sides of the image's center must follow their rays.
TEST(RefractedBeams, CrossPlanesNextToTheEye) {
  for (int turn = 0; turn < 60; ++turn) {
    SCOPED_TRACE(turn);
    Random random(static_cast<std::uint64_t>(turn));
    scenes::Camera camera;
    camera.from = {0.0F, 0.0F, 0.0F};
    camera.at = {1.0F, 0.0F, 0.0F};
    camera.up = {0.0F, 0.0F, 1.0F};
    camera.angle = 2.4F;
    const PrimaryRays image(camera, 32, 32, 1);
    const double angle = random.uniform(0.3, 1.0);
    const Rays seen = behind({{1.0, 0.0, 0.0}, {std::cos(angle), 0.0, std::sin(angle)}},
                             turn % 2 == 0 ? 1.0 / 1.5 : 1.0 / 1.33, rays_of(image));
    // A wall below the middle plane y = `middle`; above it, only a far object.
    const double middle = random.uniform(-0.002, 0.002);
    const double half = 4.0;
    scenes::SceneBuilder builder("wall");
    const auto square = [&](double x, double y_low, double y_high) {
      const dvec3 corners[] = {
          {x, y_low, -half}, {x, y_high, -half}, {x, y_high, half}, {x, y_low, half}};
      builder.add_polygon(corners);
    };
    const double face = -0.689 + random.uniform(0.01, 0.3);
    square(6.0, middle - half, middle - 0.02);
    square(face, middle - half, middle - half + 0.01);
    square(face + 2.0 * half, middle + half - 0.01, middle + half);
    const scenes::Scene scene = std::move(builder).build();
    for (const int level : {2, 3, 5}) {
      beam::BeamOptions options;
      options.octree.max_level = level;
      const beam::BeamTracer tracer(scene, options);
      const BatchMarks marks = all_refracted(seen);
      EXPECT_EQ(hits_of(tracer, {seen.rays, {}, seen.samples, &image, &marks}),
                hits_of(tracer, {seen.rays}));
    }
  }
}

// The assumption that beams rely on: beyond the band of a line, rays cross its two planes in the
// order given by the line, unless they cross both before their origins.
TEST(RefractedBeams, CrossPlanesInTheOrderOfTheLines) {
  std::size_t sure = 0, beside = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    scenes::Camera camera;
    camera.at = glm::vec3(verify::point_in_cube(random));
    camera.from = camera.at + 3.0F * glm::normalize(glm::vec3(verify::point_in_cube(random)) +
                                                    glm::vec3(0.01F));
    camera.up = {0.01F, 0.3F, 0.95F};
    camera.angle = static_cast<float>(random.uniform(1.0, 20.0));
    const PrimaryRays image(camera, 24, 24, 1);
    const Plane plane{glm::mix(dvec3(camera.from), dvec3(camera.at), 0.3),
                      glm::normalize(dvec3(image.forward()) + verify::point_in_cube(random))};
    const Rays seen = behind(plane, 1.0 / 1.5, rays_of(image));
    const auto view = beam::fitted_view(seen.rays, seen.samples, image);
    if (!view) continue;
    beam::NearbyRays nearby{.eye = view->eye, .center = view->center, .drift = view->drift};
    nearby.nearest = 1e9;
    for (std::size_t i = 0; i < seen.rays.size(); ++i) {
      const beam::Course course =
          view->course_of(seen.rays[i], beam::place_in(image, seen.samples[i]));
      nearby.deviation = std::max(nearby.deviation, course.deviation + 1e-6);
      nearby.beside_eye = std::max({nearby.beside_eye, course.beside_eye, course.drifted});
      nearby.drifted = std::max(nearby.drifted, course.drifted);
      nearby.radius = std::max(nearby.radius, course.from_center);
      nearby.nearest = std::min(nearby.nearest, course.start);
    }
    if (nearby.deviation > 0.1) continue;
    // Some planes of these cells are next to the eye.
    CellGrid grid;
    grid.cells = glm::ivec3(8);
    grid.cell = dvec3(random.uniform(0.2, 1.0));
    grid.lower = view->eye - grid.cell * 3.0 +
                 random.uniform(0.0, 3.0) * nearby.beside_eye * verify::point_in_cube(random);
    const beam::EyeView eye(grid, view->image, nearby);
    for (int a_axis = 0; a_axis < 3; ++a_axis) {
      for (int b_axis = 0; b_axis < 3; ++b_axis) {
        if (a_axis == b_axis) continue;
        for (int pair = 0; pair < 64; ++pair) {
          const beam::Crossing a = eye.crossing_of(a_axis, pair % 8);
          const beam::Crossing b = eye.crossing_of(b_axis, pair / 8);
          const beam::ImageLine line = eye.line_before(a, b);
          for (std::size_t i = 0; i < seen.rays.size(); i += 7) {
            const auto place = beam::place_in(image, seen.samples[i]);
            const glm::dvec2 at = (glm::dvec2(place.pixel) + 0.5) / 24.0;
            // Other rays are left out by `begin_beams`.
            const auto is_left = [&](const beam::Crossing& crossing) {
              beam::Crossing other = crossing;
              other.side = static_cast<std::int16_t>(-crossing.side);
              return !eye.eye_is_beside(crossing) || eye.line_toward(crossing).at(at) < 0.0 ||
                     eye.line_toward(other).at(at) < 0.0;
            };
            if (!is_left(a) || !is_left(b)) continue;
            const CellRay ray(grid, seen.rays[i]);
            const auto t_of = [&](const beam::Crossing& crossing) {
              return ray.step(crossing.axis) == crossing.side
                         ? ray.plane_t(crossing.axis, crossing.index)
                         : std::numeric_limits<double>::infinity();
            };
            if (t_of(a) <= 0.0 && t_of(b) <= 0.0) continue;
            if (std::isinf(t_of(a)) && std::isinf(t_of(b))) continue;
            const double value = line.at(at);
            if (value >= -line.band && value <= 0.0) continue;
            EXPECT_EQ(beam::crosses_before(ray, a, b), value < 0.0);
            ++sure;
            beside += eye.eye_is_beside(a) ? 1 : 0;
          }
        }
      }
    }
    if (::testing::Test::HasFailure()) return;
  }
  EXPECT_GT(sure, 1'000'000U);
  EXPECT_GT(beside, 10'000U);
}

/// Returns the maximum deviation, in pixels, of the rays of a part of an image from the view fitted
/// to them.
double deviation_of(const ThroughGlass& glass, int first, int size) {
  Rays part;
  for (std::size_t i = 0; i < glass.seen.rays.size(); ++i) {
    const glm::ivec2 at = beam::place_in(glass.image, glass.seen.samples[i]).pixel - first;
    if (std::min(at.x, at.y) < 0 || std::max(at.x, at.y) >= size) continue;
    part.rays.push_back(glass.seen.rays[i]);
    part.samples.push_back(glass.seen.samples[i]);
  }
  const auto view = beam::fitted_view(part.rays, part.samples, glass.image);
  if (!view) return 1e9;
  double most = 0.0;
  for (std::size_t i = 0; i < part.rays.size(); ++i) {
    const beam::SamplePlace place = beam::place_in(glass.image, part.samples[i]);
    most = std::max(most, view->course_of(part.rays[i], place).deviation / view->pixel());
  }
  return most;
}

// The view is correct to first order: in a part half as large, rays deviate a quarter as much.
TEST(DriftingViews, FitRefractedRaysToTheFirstOrder) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=2");
  const ThroughGlass glass(scene, 30.0, 512);
  const double whole = deviation_of(glass, 128, 128);
  const double half = deviation_of(glass, 160, 64);
  EXPECT_LT(half, whole / 3.0);
  EXPECT_LT(deviation_of(glass, 176, 32), half / 3.0);
  EXPECT_LT(half, 2.5);
}

TEST(DriftingViews, OfAnImageEqualTheImage) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=2");
  const PrimaryRays image(scene.cameras.front(), 40, 30, 1);
  Rays rays = rays_of(image);
  for (Ray& ray : rays.rays) ray.origin += 2.0F * ray.direction;
  const auto view = beam::fitted_view(rays.rays, rays.samples, image);
  ASSERT_TRUE(view);
  EXPECT_LT(glm::length(view->eye - dvec3(image.eye())), 1e-3);
  EXPECT_LT(glm::length(view->image.forward() - image.forward()), 1e-5);
  EXPECT_LT(glm::length(view->image.right() - image.right()), 1e-7);
  EXPECT_LT(glm::length(view->drift[0]) + glm::length(view->drift[1]), 1e-3);
  // A row has no second direction.
  rays.rays.resize(40);
  rays.samples.resize(40);
  EXPECT_FALSE(beam::fitted_view(rays.rays, rays.samples, image));
}

}  // namespace
}  // namespace beambench::accel

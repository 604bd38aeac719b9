// Beam tracing of polygons: the hits of exhaustive search wherever polygons meet each other and the
// eye, and beams that cover the image.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include "accel/core/inspector_of.hpp"
#include "accel/core/registry.hpp"
#include "harness/verify/selftest/subject.hpp"
#include "harness/verify/selftest/test_scenes.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/accel/built.hpp"
#include "tests/random_scene.hpp"
#include "tests/random_view.hpp"

namespace beambench::accel {
namespace {

constexpr verify::PrimitiveKinds kPolygons{.spheres = false, .cones = false};

HitBuffer hits_of(const std::string& structure, const scenes::Scene& scene, const PrimaryRays& rays,
                  WorkCounters* counters = nullptr) {
  HitBuffer hits(rays.width(), rays.height(), rays.samples());
  tests::build(structure, scene)->closest_hits(rays, hits, {counters});
  return hits;
}

/// Expects the hits of exhaustive search with a single leaf, with few polygons per leaf, and with
/// the maximum number of divisions. Returns how many samples hit something.
std::size_t expect_hits_of_exhaustive(const scenes::Scene& scene, const PrimaryRays& rays) {
  const HitBuffer expected = hits_of("exhaustive", scene, rays);
  for (const char* parameters :
       {"", ":max_polygons=1", ":max_polygons=1,max_depth=2", ":max_polygons=2,max_depth=48"}) {
    EXPECT_EQ(hits_of(std::string("polygon-beam") + parameters, scene, rays), expected)
        << parameters;
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) count += expected.get(i) ? 1 : 0;
  return count;
}

PrimaryRays random_image(const scenes::Camera& camera, Random& random) {
  return {camera, 1 + static_cast<int>(random.below(40)), 1 + static_cast<int>(random.below(40)),
          std::array{1, 4, 5}[random.below(3)]};
}

/// Uses soups of triangles and concave polygons, some of them coplanar, equal or needles, and eyes
/// on polygons.
TEST(PolygonBeam, MatchesExhaustiveForCamerasAnywhere) {
  std::size_t hits = 0;
  for (std::uint64_t seed = 1; seed <= 800 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const scenes::Scene scene =
        random.below(2) == 0
            ? verify::random_scene(seed, static_cast<int>(1 + random.below(60)), kPolygons)
            : verify::family_scene(seed, kPolygons);
    scenes::Camera camera = verify::random_camera(scene, random);
    if (random.below(3) == 0) {
      camera.angle = std::array{0.001F, 0.1F, 90.0F, 170.0F, 179.0F, 179.99F}[random.below(6)];
    }
    if (random.below(4) == 0) camera.aspect = std::array{0.02F, 40.0F}[random.below(2)];
    hits += expect_hits_of_exhaustive(scene, random_image(camera, random));
  }
  EXPECT_GT(hits, 100'000U);
}

glm::dvec3 tilted(const glm::dvec3& point, const glm::dvec3& axis) {
  return glm::length(axis) > 0.0 ? point - 2.0 * glm::dot(point, axis) * axis : point;
}

/// Uses layers one behind another, at distances from below float resolution to more than the
/// overlap of cells. Ids are in random order, so that ties must be found.
TEST(PolygonBeam, SeesTheNearestOfArbitrarilyCloseLayers) {
  for (std::uint64_t seed = 1; seed <= 300 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    scenes::SceneBuilder builder("layers");
    const glm::dvec3 axis =
        random.below(2) == 0 ? glm::dvec3(0.0) : tests::random_direction(random);
    const double gap = std::ldexp(1.0, -static_cast<int>(8 + random.below(20)));
    for (int i = 0; i < 40; ++i) {
      const double depth = gap * static_cast<double>(random.below(6));
      const double x = random.uniform(-1.0, 0.5);
      const double y = random.uniform(-1.0, 0.5);
      const double size = random.uniform(0.1, 1.0);
      // Every third triangle stands on the layers or ends at them.
      const bool stands = i % 3 == 0;
      const double other = stands ? depth + (random.below(2) == 0 ? size : -size) : depth;
      builder.add_polygon(std::array{tilted({x, y, depth}, axis),
                                     tilted({x + size, y, depth}, axis),
                                     tilted({x + size, y + (stands ? 0.0 : size), other}, axis),
                                     tilted({x, y + (stands ? 0.0 : size), other}, axis)});
    }
    const scenes::Scene scene = std::move(builder).build();
    scenes::Camera camera;
    const double distance = std::array{0.01, 2.0, 3.0, 200.0, 5000.0}[random.below(5)];
    camera.from = glm::vec3(tilted({random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5),
                                    random.below(2) == 0 ? distance : -distance},
                                   axis));
    camera.at = glm::vec3(tilted({random.uniform(-0.5, 0.5), 0.0, 0.0}, axis));
    camera.up = glm::vec3(tilted({0.0, 1.0, 0.0}, axis));
    camera.angle = distance > 100.0 ? static_cast<float>(200.0 / distance) : 60.0F;
    expect_hits_of_exhaustive(scene, PrimaryRays(camera, 48, 36, 1));
  }
}

/// Intersecting triangles, with the eye in their planes, on them and among them.
TEST(PolygonBeam, CutsPolygonsThatPassThroughEachOtherAndTheEye) {
  for (std::uint64_t seed = 1; seed <= 300 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    scenes::SceneBuilder builder("around the eye");
    const auto point = [&](double size) { return size * verify::point_in_cube(random); };
    for (int i = 0; i < 25; ++i) {
      const double size = std::array{0.1, 2.0, 100.0}[random.below(3)];
      std::array corners{point(size), point(size), point(size)};
      if (random.below(4) == 0) corners[2] = -(corners[0] + corners[1]);  // the eye is its center
      if (random.below(8) == 0) corners[2] = 0.5 * (corners[0] + corners[1]) + point(1e-4);
      builder.add_polygon(corners);
    }
    const scenes::Scene scene = std::move(builder).build();
    scenes::Camera camera;
    camera.from = glm::vec3(0.0F);
    camera.at = glm::vec3(point(1.0));
    camera.up = {0.0F, 0.0F, 1.0F};
    camera.angle = std::array{20.0F, 90.0F, 160.0F}[random.below(3)];
    expect_hits_of_exhaustive(scene, PrimaryRays(camera, 33, 21, 1));
  }
}

TEST(PolygonBeam, MatchesExhaustiveOnCatalogScenes) {
  for (const char* name :
       {"tetra:n=4", "stetra", "gears:n=1", "misil", "bola-espacial", "tetera", "maceta",
        "closed-room:detail=4", "bumpy:triangles=3072", "soup:triangles=2000"}) {
    const scenes::Scene scene = scenes::load_scene(name);
    Random random(1);
    for (const int samples : {1, 5}) {
      SCOPED_TRACE(fmt::format("{}, {} samples", name, samples));
      const PrimaryRays rays(scene.cameras.front(), 40, 30, samples);
      EXPECT_EQ(hits_of("polygon-beam", scene, rays), hits_of("exhaustive", scene, rays));
      const PrimaryRays elsewhere(tests::random_view(scene, random), 32, 32, samples);
      EXPECT_EQ(hits_of("polygon-beam", scene, elsewhere), hits_of("exhaustive", scene, elsewhere));
    }
  }
}

TEST(PolygonBeam, FindsAnyHitsOfAnImage) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=3");
  const PrimaryRays rays(scene.cameras.front(), 31, 22, 5);
  std::vector<std::uint8_t> any(rays.count(), 2);
  tests::build("polygon-beam", scene)->any_hits(rays, any, {.threads = 3});
  const HitBuffer hits = hits_of("exhaustive", scene, rays);
  for (std::size_t i = 0; i < any.size(); ++i) ASSERT_EQ(any[i] != 0, hits.get(i).has_value()) << i;
}

TEST(PolygonBeam, AcceptsOnlyImagesOfPolygons) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=1");
  const auto structure = tests::build("polygon-beam", scene);
  EXPECT_THROW(structure->closest_hit(Ray{}), UnsupportedError);
  EXPECT_THROW(structure->any_hit(Ray{}), UnsupportedError);
  const std::vector<Ray> rays(2);
  HitBuffer hits(2, 1, 1);
  EXPECT_THROW(structure->closest_hits(RayBatch{rays}, hits, {}), UnsupportedError);
  for (const char* name : {"balls:n=1", "rings:n=1"}) {
    EXPECT_THROW(tests::build("polygon-beam", scenes::load_scene(name)), UnsupportedError) << name;
  }
}

TEST(PolygonBeam, RefusesATreeOfTooManyFragments) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=4");
  const std::string refusal = tests::refusal("polygon-beam:max_references=100", scene);
  for (const char* word : {"max_references=100", "max_polygons", "max_depth"}) {
    EXPECT_NE(refusal.find(word), std::string::npos) << refusal;
  }
}

/// Returns whether a point is in a convex polygon, or not farther than `slack` outside.
bool contains(const std::vector<glm::dvec2>& corners, const glm::dvec2& point, double slack) {
  double least = 0.0;
  double most = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 edge = corners[(i + 1) % corners.size()] - corners[i];
    const glm::dvec2 to = point - corners[i];
    const double length = glm::length(edge);
    if (length < 1e-12) continue;
    const double beside = (edge.x * to.y - edge.y * to.x) / length;
    least = std::min(least, beside);
    most = std::max(most, beside);
  }
  return least >= -slack || most <= slack;
}

TEST(PolygonBeam, CoversTheImageWithBeams) {
  for (const char* name : {"tetra:n=4", "closed-room:detail=4", "gears:n=1"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    const PrimaryRays rays(scene.cameras.front(), 40, 30, 5);
    const HitBuffer hits = hits_of("exhaustive", scene, rays);
    const auto structure = tests::build("polygon-beam", scene);
    const auto beams = inspector_of(*structure).beams(rays).value();
    std::vector<int> decided(rays.count(), 0);
    for (const BeamOutline& beam : beams) {
      EXPECT_EQ(beam.samples.empty(), beam.kind == BeamKind::kLeaving);
      for (const std::size_t sample : beam.samples) ++decided[sample];
    }
    std::size_t on_edges = 0;
    std::size_t repeated = 0;
    for (int y = 0; y < rays.height(); ++y) {
      for (int x = 0; x < rays.width(); ++x) {
        for (int sample = 0; sample < rays.samples(); ++sample) {
          const std::size_t index = hits.index(x, y, sample);
          if (decided[index] > 0) {
            EXPECT_TRUE(hits.get(index).has_value());
            repeated += decided[index] > 1 ? 1 : 0;
            continue;
          }
          on_edges += hits.get(index) ? 1 : 0;
          const glm::dvec2 place =
              glm::dvec2(x, y) + rays.offsets()[static_cast<std::size_t>(sample)];
          EXPECT_TRUE(std::ranges::any_of(beams, [&](const BeamOutline& beam) {
            return beam.kind == BeamKind::kLeaving && contains(beam.corners, place, 1e-5);
          }));
        }
      }
    }
    EXPECT_LT(on_edges, rays.count() / 50);
    EXPECT_LT(repeated, rays.count() / 50);
  }
}

}  // namespace
}  // namespace beambench::accel

// Rays that begin on a surface: the interval is closed, so a hit at t = 0 counts, and its t is +0.

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "scenes/base/random.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/accel/bits.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

/// Returns a star with 15 corners, not in an axis-aligned plane.
scenes::Scene star() {
  scenes::SceneBuilder builder("star");
  std::vector<glm::dvec3> corners;
  for (int i = 0; i < 15; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 15.0;
    const double radius = i % 2 == 0 ? 0.7 : 1.0;
    const double x = radius * std::cos(angle);
    corners.emplace_back(x, radius * std::sin(angle), 0.3 * x);
  }
  builder.add_polygon(corners);
  return std::move(builder).build();
}

/// Returns rays from the corners, edges and faces of triangles.
std::vector<Ray> rays_from_triangles(const scenes::Scene& scene, Random& random) {
  std::vector<Ray> rays;
  for (const scenes::Triangle& triangle : scene.triangles) {
    const glm::dvec3 a(scene.vertices[triangle.vertex[0]]);
    const glm::dvec3 b(scene.vertices[triangle.vertex[1]]);
    const glm::dvec3 c(scene.vertices[triangle.vertex[2]]);
    for (const glm::dvec3& place :
         {a, b, c, a + random.unit() * (b - a), b + random.unit() * (c - b), (a + b + c) / 3.0}) {
      for (int i = 0; i < 4; ++i) {
        Ray ray;
        ray.origin = glm::vec3(place);
        ray.direction = glm::vec3(verify::point_in_cube(random));
        rays.push_back(ray);
      }
    }
  }
  return rays;
}

/// Expects the hits of exhaustive search, bit for bit; returns the number of hits at t = 0.
int expect_bits_of_exhaustive(const std::string& spec, const scenes::Scene& scene,
                              const std::vector<Ray>& rays) {
  const exhaustive::Exhaustive exhaustive(scene);
  const auto structure = registry().choose(parse_spec(spec)).build(scene);
  int at_zero = 0;
  for (const Ray& ray : rays) {
    const auto hit = exhaustive.closest_hit(ray, nullptr);
    EXPECT_EQ(tests::bits_of(structure->closest_hit(ray, nullptr)), tests::bits_of(hit));
    EXPECT_EQ(structure->any_hit(ray, nullptr), hit.has_value());
    if (hit && hit->t == 0.0F) ++at_zero;
    EXPECT_FALSE(hit && std::signbit(hit->t));
  }
  return at_zero;
}

class HitsAtZero : public ::testing::TestWithParam<std::string> {};

TEST_P(HitsAtZero, MatchExhaustiveAtTheCornersOfAPolygon) {
  const scenes::Scene scene = star();
  Random random(1);
  EXPECT_GT(expect_bits_of_exhaustive(GetParam(), scene, rays_from_triangles(scene, random)), 50);
}

TEST_P(HitsAtZero, MatchExhaustiveInRandomScenes) {
  int at_zero = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 12);
    Random random(seed);
    at_zero += expect_bits_of_exhaustive(GetParam(), scene, rays_from_triangles(scene, random));
  }
  EXPECT_GT(at_zero, 1000);
}

INSTANTIATE_TEST_SUITE_P(All, HitsAtZero, ::testing::ValuesIn(tests::exact_structures()),
                         tests::name_of_structure);

}  // namespace
}  // namespace beambench::accel

// Rays that begin on or next to triangles, where float tests might reject hits.

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "accel/core/tolerance.hpp"
#include "accel/core/work_counters.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "scenes/base/parameters.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::accel {
namespace {

/// Returns triangles of all shapes, including needles, in a box of the given size.
scenes::Scene triangles_of_size(double size, std::uint64_t seed) {
  scenes::SceneBuilder builder("triangles");
  Random random(seed);
  const auto point = [&] {
    return glm::dvec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  };
  for (int i = 0; i < 150; ++i) {
    const glm::dvec3 a = point() * size;
    const glm::dvec3 b = a + point() * size * (i % 3 == 0 ? 0.01 : 0.5);
    builder.add_polygon(
        std::array<glm::dvec3, 3>{a, b, b + point() * size * (i % 5 == 0 ? 1e-5 : 0.5)});
  }
  return std::move(builder).build();
}

/// Returns rays from a point of a triangle, rounded to float, and from one moved along the normal
/// by `lift`.
std::vector<Ray> rays_from(const scenes::Scene& scene, double lift, Random& random) {
  std::vector<Ray> rays;
  for (const scenes::Triangle& triangle : scene.triangles) {
    const glm::dvec3 a(scene.vertices[triangle.vertex[0]]);
    const glm::dvec3 e = glm::dvec3(scene.vertices[triangle.vertex[1]]) - a;
    const glm::dvec3 f = glm::dvec3(scene.vertices[triangle.vertex[2]]) - a;
    const double u = random.unit();
    const double v = random.uniform(0, 1 - u);
    const glm::dvec3 normal = glm::normalize(glm::cross(e, f));
    for (const double moved : {0.0, lift, -lift, 0.01 * lift, 1e-42}) {
      Ray ray;
      ray.origin = glm::vec3(a + u * e + v * f + moved * normal);
      ray.direction = glm::vec3{random.uniform(-1, 1), random.uniform(-1, 1),
                                random.unit() < 0.2 ? 0.0 : random.uniform(-1, 1)};
      if (random.unit() < 0.3) ray.direction *= 1e-6F;
      rays.push_back(ray);
    }
  }
  return rays;
}

class RaysFromSurfaces : public ::testing::TestWithParam<const char*> {};

TEST_P(RaysFromSurfaces, MatchExhaustive) {
  for (const double size : {1e-9, 1e-6, 1e-3, 1.0, 1e5, 1e8}) {
    SCOPED_TRACE(size);
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      const scenes::Scene scene = triangles_of_size(size, seed);
      const exhaustive::Exhaustive exhaustive(scene);
      const auto structure = registry().choose(parse_spec(GetParam())).build(scene);
      Random random(seed);
      for (const Ray& ray : rays_from(scene, mirror_lift(scene.bounds), random)) {
        const auto hit = exhaustive.closest_hit(ray, nullptr);
        ASSERT_EQ(structure->closest_hit(ray, nullptr), hit);
        ASSERT_EQ(structure->any_hit(ray, nullptr), hit.has_value());
      }
    }
  }
}
INSTANTIATE_TEST_SUITE_P(All, RaysFromSurfaces,
                         ::testing::Values("sah-bvh", "sah-bvh:builder=spatial", "kd-tree"));

// The triangle that a ray leaves is not confirmed: on closed meshes, that was most of the work.
TEST(SecondaryRays, DoNotConfirmTheirOwnTriangle) {
  const scenes::Scene scene = scenes::load_scene("bumpy:triangles=5000");
  for (const char* name : {"sah-bvh", "kd-tree"}) {
    SCOPED_TRACE(name);
    const auto structure = registry().choose(parse_spec(name)).build(scene);
    Random random(1);
    WorkCounters work;
    std::uint64_t rays = 0;
    std::uint64_t hits = 0;
    for (const scenes::Triangle& triangle : scene.triangles) {
      std::array<glm::dvec3, 3> corner;
      for (std::size_t i = 0; i < 3; ++i) corner[i] = scene.vertices[triangle.vertex[i]];
      const glm::dvec3 normal =
          glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
      const glm::dvec3 middle = (corner[0] + corner[1] + corner[2]) / 3.0;
      Ray ray;
      ray.origin = glm::vec3(middle + surface_lift(middle, middle) * normal);
      ray.direction =
          glm::vec3(normal + 0.7 * glm::dvec3{random.uniform(-1, 1), random.uniform(-1, 1), 0.0});
      ++rays;
      hits += structure->any_hit(ray, &work) ? 1 : 0;
    }
    EXPECT_LT(work.by_name().at("confirmed_tests"), hits + rays / 10);
  }
}

}  // namespace
}  // namespace beambench::accel

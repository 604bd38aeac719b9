// The stand-ins for the thesis's scenes: no primitive serves only to reach a count.

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/box.hpp"

namespace beambench::accel {
namespace {

struct StandIn {
  const char* name;
  std::size_t polygons, spheres;  ///< thesis, table 5.1
  bool inside = false;            ///< a closed room, seen from its camera
};

void PrintTo(const StandIn& scene, std::ostream* stream) { *stream << scene.name; }

constexpr std::array<StandIn, 15> kStandIns = {{{"ajedrez", 19734, 0},
                                                {"bola-espacial", 1536, 0},
                                                {"caracol", 0, 5671},
                                                {"casa-de-campo", 12172, 0},
                                                {"delfines", 1692, 0},
                                                {"escena1", 0, 430},
                                                {"escena2", 1, 91},
                                                {"flamenco", 12874, 0},
                                                {"gato-bill", 15128, 0},
                                                {"habitacion", 34110, 0, true},
                                                {"maceta", 1284, 0},
                                                {"misil", 956, 0},
                                                {"stetra", 256, 0},
                                                {"tetera", 1004, 0},
                                                {"torre-eiffel", 16648, 0}}};

class StandIns : public testing::TestWithParam<StandIn> {};

TEST_P(StandIns, HaveTheThesissCounts) {
  const scenes::Scene scene = scenes::load_scene(GetParam().name);
  EXPECT_EQ(scene.polygons.size(), GetParam().polygons);
  EXPECT_EQ(scene.spheres.size(), GetParam().spheres);
  EXPECT_EQ(scene.primitives.size(), GetParam().polygons + GetParam().spheres);
}

using Place = std::tuple<float, float, float>;
Place place_of(const glm::vec3& p) { return {p.x, p.y, p.z}; }

TEST_P(StandIns, RepeatNoPrimitive) {
  const scenes::Scene scene = scenes::load_scene(GetParam().name);
  std::set<std::set<Place>> polygons;
  for (const scenes::Polygon& polygon : scene.polygons) {
    std::set<Place> corners;
    for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
      corners.insert(place_of(scene.vertices[scene.corners[polygon.first_corner + i]]));
    }
    EXPECT_TRUE(polygons.insert(corners).second) << "polygon " << &polygon - scene.polygons.data();
  }
  std::set<std::tuple<Place, float>> spheres;
  for (const scenes::Sphere& sphere : scene.spheres) {
    EXPECT_TRUE(spheres.insert({place_of(sphere.center), sphere.radius}).second);
  }
}

/// Expects no slivers: every polygon has an area that is not tiny compared with its longest side.
TEST_P(StandIns, HaveNoPolygonWithoutArea) {
  const scenes::Scene scene = scenes::load_scene(GetParam().name);
  for (std::size_t id = 0; id < scene.polygons.size(); ++id) {
    const scenes::Polygon& polygon = scene.polygons[id];
    double area = 0.0;
    double longest = 0.0;
    for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
      const scenes::Triangle& triangle = scene.triangles[polygon.first_triangle + i];
      const glm::dvec3 a(scene.vertices[triangle.vertex[0]]);
      const glm::dvec3 b(scene.vertices[triangle.vertex[1]]);
      const glm::dvec3 c(scene.vertices[triangle.vertex[2]]);
      area += 0.5 * glm::length(glm::cross(b - a, c - a));
      longest = std::max({longest, glm::length(b - a), glm::length(c - b), glm::length(a - c)});
    }
    EXPECT_GT(area, 1e-4 * longest * longest) << "polygon " << id;
  }
}

/// Searches for an unobstructed line of sight from a polygon to a plausible viewpoint.
class Onlooker {
 public:
  Onlooker(const scenes::Scene& scene, bool inside)
      : scene_(scene), structure_(registry().choose(Spec{"sah-bvh", {}}).build(scene)) {
    const glm::dvec3 lower(scene.bounds.lower);
    const glm::dvec3 extent(glm::dvec3(scene.bounds.upper) - lower);
    size_ = glm::length(extent);
    if (!inside) return;
    // In a closed room, eyes are at points that its camera sees.
    const glm::dvec3 camera(scene.cameras[0].from);
    while (eyes_.size() < 256) {
      const glm::dvec3 eye =
          lower + extent * glm::dvec3{random_.unit(), random_.unit(), random_.unit()};
      if (!blocked(camera, eye - camera, 1.0)) eyes_.push_back(eye);
    }
  }

  bool sees(const scenes::Polygon& polygon) {
    constexpr int kTries = 1500;
    for (int i = 0; i < kTries; ++i) {
      const glm::dvec3 point = point_on(polygon);
      if (eyes_.empty()) {
        const glm::dvec3 path =
            2.0 * glm::dvec3{random_.unit(), random_.unit(), random_.unit()} - glm::dvec3(1.0);
        if (!blocked(point, glm::normalize(path) * size_, 1.0)) return true;
      } else {
        const glm::dvec3 path = eyes_[random_.below(eyes_.size())] - point;
        if (!blocked(point, path, 1.0)) return true;
      }
    }
    return false;
  }

 private:
  glm::dvec3 point_on(const scenes::Polygon& polygon) {
    const auto chosen = static_cast<std::uint32_t>(random_.below(polygon.triangle_count));
    const scenes::Triangle& triangle = scene_.triangles[polygon.first_triangle + chosen];
    double u = random_.unit();
    double v = random_.unit();
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const glm::dvec3 a(scene_.vertices[triangle.vertex[0]]);
    const glm::dvec3 b(scene_.vertices[triangle.vertex[1]]);
    const glm::dvec3 c(scene_.vertices[triangle.vertex[2]]);
    return a + u * (b - a) + v * (c - a);
  }

  /// Returns whether anything lies in between, other than the starting polygon.
  bool blocked(const glm::dvec3& from, const glm::dvec3& path, double end) const {
    Ray ray;
    ray.origin = glm::vec3(from);
    ray.direction = glm::vec3(path);
    ray.t_min = static_cast<float>(1e-5 * size_ / glm::length(path));
    ray.t_max = static_cast<float>(end);
    return structure_->any_hit(ray, nullptr);
  }

  const scenes::Scene& scene_;
  std::unique_ptr<Accelerator> structure_;
  Random random_{1};
  double size_ = 0.0;
  std::vector<glm::dvec3> eyes_;
};

// Spheres of the SPD's flake and shell overlap by definition; those scenes are Haines's own.
TEST_P(StandIns, HideNearlyNothing) {
  const scenes::Scene scene = scenes::load_scene(GetParam().name);
  Onlooker onlooker(scene, GetParam().inside);
  std::vector<std::size_t> hidden;
  for (std::size_t id = 0; id < scene.polygons.size(); ++id) {
    if (!onlooker.sees(scene.polygons[id])) hidden.push_back(id);
  }
  EXPECT_LE(100 * hidden.size(), scene.polygons.size()) << testing::PrintToString(hidden);
}

INSTANTIATE_TEST_SUITE_P(Thesis, StandIns, testing::ValuesIn(kStandIns), [](const auto& info) {
  std::string name = info.param.name;
  std::erase(name, '-');
  return name;
});

TEST(Onlooker, SeesABoxInABoxOnlyFromInside) {
  scenes::SceneBuilder builder("boxes");
  builder.add_camera({.from = {0.9F, 0.5F, 0.5F}, .at = {0.0F, 0.5F, 0.5F}, .up = {0, 0, 1}});
  scenes::modelling::add_flat(builder, scenes::modelling::box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}));
  scenes::modelling::add_flat(builder, scenes::modelling::box({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6}));
  scenes::modelling::add_flat(builder,
                              scenes::modelling::box({0.45, 0.45, 0.45}, {0.55, 0.55, 0.55}));
  const scenes::Scene scene = std::move(builder).build();
  Onlooker outside(scene, false);
  Onlooker inside(scene, true);
  for (std::size_t id = 0; id < scene.polygons.size(); ++id) {
    EXPECT_EQ(outside.sees(scene.polygons[id]), id < 6) << id;
    EXPECT_EQ(inside.sees(scene.polygons[id]), id < 12) << id;
  }
}

// Whole images are verified by `beambench verify`; this test covers scenes too large for that.
TEST_P(StandIns, MatchExhaustiveForASampleOfRays) {
  const scenes::Scene scene = scenes::load_scene(GetParam().name);
  const auto exhaustive = registry().choose({"exhaustive", {}}).build(scene);
  const auto sah = registry().choose({"sah-bvh", {}}).build(scene);
  const auto samet = registry().choose({"samet", {}}).build(scene);
  const PrimaryRays rays(scene.cameras.front(), 1280, 1024, 1);
  Random random(1999);
  int hits = 0;
  for (int i = 0; i < 300; ++i) {
    const auto x = static_cast<int>(random.below(1280));
    const auto y = static_cast<int>(random.below(1024));
    const Ray ray = rays.ray(x, y, 0);
    const auto expected = exhaustive->closest_hit(ray, nullptr);
    ASSERT_EQ(sah->closest_hit(ray, nullptr), expected) << i;
    ASSERT_EQ(samet->closest_hit(ray, nullptr), expected) << i;
    hits += expected ? 1 : 0;
  }
  EXPECT_GT(hits, 0);
}

TEST(Habitacion, IsClosed) {
  const scenes::Scene scene = scenes::load_scene("habitacion");
  const auto structure = registry().choose(Spec{"sah-bvh", {}}).build(scene);
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    Ray ray;
    ray.origin = scene.cameras[0].from;
    ray.direction =
        glm::vec3{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
    ASSERT_TRUE(structure->any_hit(ray, nullptr)) << "ray " << i;
  }
}

TEST(Caracol, IsTheShellWithoutItsTip) {
  const scenes::Scene whole = scenes::load_scene("shells:n=5");
  const scenes::Scene cut = scenes::load_scene("caracol");
  const std::size_t left_out = whole.spheres.size() - cut.spheres.size();
  EXPECT_EQ(left_out, 90U);
  for (std::size_t i = 0; i < cut.spheres.size(); ++i) {
    EXPECT_EQ(cut.spheres[i].center, whole.spheres[i + left_out].center);
    EXPECT_EQ(cut.spheres[i].radius, whole.spheres[i + left_out].radius);
  }
}

}  // namespace
}  // namespace beambench::accel

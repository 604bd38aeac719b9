// Pencils whose rays begin on surfaces: like single rays, tile-beam hits these surfaces at t = 0.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/ray_batch.hpp"
#include "accel/core/work_counters.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "accel/tile_beam/tile_beam.hpp"
#include "harness/verify/contact.hpp"
#include "scenes/base/random.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/only_target.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel::tile_beam {
namespace {

using Corners = std::vector<glm::dvec3>;

void add_floor(scenes::SceneBuilder& builder) {
  builder.add_polygon(Corners{{-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}});
}

/// Returns a floor, and a wall in the plane x = 0.
scenes::Scene wall() {
  scenes::SceneBuilder builder("wall");
  add_floor(builder);
  builder.add_polygon(Corners{{0, 0, -3}, {0, 0, 3}, {0, 1, 3}, {0, 1, -3}});
  return std::move(builder).build();
}

/// Returns a triangular prism, turned so that no face is axis-aligned.
scenes::Scene prism() {
  scenes::SceneBuilder builder("prism");
  const auto corner = [](int i, double height) {
    const double angle = 0.4 + 2.1 * i;
    return glm::dvec3(std::cos(angle) + 0.3 * height, height + 0.2 * std::sin(angle),
                      std::sin(angle) - 0.1 * height);
  };
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    builder.add_polygon(Corners{corner(i, -1), corner(next, -1), corner(next, 1), corner(i, 1)});
  }
  builder.add_polygon(Corners{corner(0, -1), corner(1, -1), corner(2, -1)});
  builder.add_polygon(Corners{corner(0, 1), corner(1, 1), corner(2, 1)});
  return std::move(builder).build();
}

/// Returns spheres whose radii and centers make their points along the axes exact.
scenes::Scene spheres() {
  scenes::SceneBuilder builder("spheres");
  add_floor(builder);
  builder.add_sphere({0.0, 1.0, 0.0}, 1.0);
  builder.add_sphere({2.0, 0.5, 1.0}, 0.25);
  builder.add_sphere({-2.0, 0.0, 2.0}, 2.0);
  return std::move(builder).build();
}

/// Returns points on the surfaces of a scene, as exact as floats allow: corners and faces of
/// triangles, and the extremes of spheres along the axes. Points on edges are excluded: rounded,
/// they lie outside the faces, where neither outcome is required.
std::vector<glm::vec3> places_on(const scenes::Scene& scene, Random& random, int of_each) {
  std::vector<glm::vec3> places;
  for (const scenes::Triangle& triangle : scene.triangles) {
    const glm::dvec3 a(scene.vertices[triangle.vertex[0]]);
    const glm::dvec3 b(scene.vertices[triangle.vertex[1]]);
    const glm::dvec3 c(scene.vertices[triangle.vertex[2]]);
    for (const glm::dvec3& corner : {a, b, c}) places.emplace_back(corner);
    for (int i = 0; i < of_each; ++i) {
      const double u = random.unit();
      const double v = random.uniform(0.0, 1.0 - u);
      places.emplace_back(a + u * (b - a) + v * (c - a));
    }
  }
  for (const scenes::Sphere& sphere : scene.spheres) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const float sign : {-1.0F, 1.0F}) {
        places.push_back(sphere.center);
        places.back()[axis] += sign * sphere.radius;
      }
    }
  }
  return places;
}

struct Counts {
  std::size_t at_origin = 0;  ///< rays whose first hit is at t = 0, up to rounding
  std::size_t beams = 0;      ///< parts of pencils that were traced together
};

bool is_at_origin(const std::optional<Hit>& hit) { return hit && hit->t < 1e-6F; }

/// Casts shadow rays from the points toward a light: each must hit if it does in exhaustive search,
/// except at the very edge of a triangle.
Counts expect_shadows_of_exhaustive(const scenes::Scene& scene, const TileBeam& structure,
                                    const std::vector<glm::vec3>& places, const glm::vec3& light) {
  std::vector<Ray> rays;
  // Repeats the points until the pencil has enough rays not to be traced by single rays.
  for (int i = 0; i < 1 + 2000 / static_cast<int>(places.size()); ++i) {
    for (const glm::vec3& place : places) rays.push_back({place, 0.0F, light - place, 1.0F});
  }
  std::erase_if(rays, [](const Ray& ray) { return ray.direction == glm::vec3(0.0F); });
  const std::vector<Pencil> pencils{
      {.first = 0, .count = rays.size(), .apex = light, .toward = true}};
  std::vector<std::uint8_t> any(rays.size());
  WorkCounters work;
  structure.any_hits(accel::RayBatch{rays, pencils, {}, nullptr}, any, {&work});
  const exhaustive::Exhaustive exhaustive(scene);
  Counts counts;
  counts.beams = work.by_name()["beams"];
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto hit = exhaustive.closest_hit(rays[i], nullptr);
    counts.at_origin += is_at_origin(hit) ? 1U : 0U;
    if ((any[i] == 1) == hit.has_value()) continue;
    // At an edge, float may place the ray outside the triangle.
    if (hit && verify::boundary_distance(scene, rays[i], hit->primitive) < 1e-6) continue;
    ADD_FAILURE() << "ray " << i << " from " << rays[i].origin.x << ' ' << rays[i].origin.y << ' '
                  << rays[i].origin.z << " to " << light.x << ' ' << light.y << ' ' << light.z
                  << ": expected " << (hit ? "a hit at t = " : "no hit ") << (hit ? hit->t : 0.0F);
    break;
  }
  return counts;
}

/// Returns lights around a scene at several distances, and one within it.
std::vector<glm::vec3> lights_around(Random& random) {
  std::vector<glm::vec3> lights;
  for (const double distance : {0.3, 3.0, 7.0, 30.0}) {
    for (int i = 0; i < 3; ++i) {
      lights.emplace_back(distance * glm::normalize(verify::point_in_cube(random)));
    }
  }
  return lights;
}

void expect_shadows_at_zero(const scenes::Scene& scene) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const tests::OnlyTarget only(target);
    const TileBeam structure(scene, {});
    Random random(7);
    Counts sum;
    for (const glm::vec3& light : lights_around(random)) {
      const Counts counts =
          expect_shadows_of_exhaustive(scene, structure, places_on(scene, random, 60), light);
      sum.at_origin += counts.at_origin;
      sum.beams += counts.beams;
    }
    EXPECT_GT(sum.at_origin, 1000U);
    EXPECT_GT(sum.beams, 0U);
  }
}

// Of 3,055 shadow rays whose origins lie in the plane of the wall, 25 hits were once lost.
TEST(PencilsAtZero, HaveTheShadowsOfRaysFromAWall) { expect_shadows_at_zero(wall()); }
TEST(PencilsAtZero, HaveTheShadowsOfRaysFromAPrism) { expect_shadows_at_zero(prism()); }
TEST(PencilsAtZero, HaveTheShadowsOfRaysFromSpheres) { expect_shadows_at_zero(spheres()); }

/// Casts rays from the points away from an apex: the first hit of each must be that of exhaustive
/// search, exactly at t = 0 and up to float precision elsewhere.
Counts expect_reflections_of_exhaustive(const scenes::Scene& scene, const TileBeam& structure,
                                        const std::vector<glm::vec3>& places,
                                        const glm::vec3& apex) {
  std::vector<Ray> rays;
  for (const glm::vec3& place : places) rays.push_back({place, 0.0F, place - apex, kInfinity});
  std::erase_if(rays, [](const Ray& ray) { return glm::length(ray.direction) < 0.1F; });
  const std::vector<Pencil> pencils{
      {.first = 0, .count = rays.size(), .apex = apex, .toward = false}};
  HitBuffer buffer(static_cast<int>(rays.size()), 1, 1);
  WorkCounters work;
  structure.closest_hits(accel::RayBatch{rays, pencils, {}, nullptr}, buffer, {&work});
  const exhaustive::Exhaustive exhaustive(scene);
  Counts counts;
  counts.beams = work.by_name()["beams"];
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto expected = exhaustive.closest_hit(rays[i], nullptr);
    const auto found = buffer.get(i);
    EXPECT_GE(found ? found->t : 0.0F, 0.0F);
    if (!is_at_origin(expected)) continue;
    ++counts.at_origin;
    if (found && found->t < 1e-5F) continue;
    ADD_FAILURE() << "ray " << i << " from " << rays[i].origin.x << ' ' << rays[i].origin.y << ' '
                  << rays[i].origin.z << ": expected a hit at t = 0, found "
                  << (found ? found->t : kInfinity);
    break;
  }
  return counts;
}

TEST(PencilsAtZero, HaveTheReflectionsOfRaysFromSurfaces) {
  for (const scenes::Scene& scene : {wall(), prism(), spheres()}) {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      SCOPED_TRACE(scene.name + " on " + hwy::TargetName(target));
      const tests::OnlyTarget only(target);
      const TileBeam structure(scene, {});
      Random random(3);
      Counts sum;
      for (const glm::vec3& apex : lights_around(random)) {
        const Counts counts =
            expect_reflections_of_exhaustive(scene, structure, places_on(scene, random, 60), apex);
        sum.at_origin += counts.at_origin;
        sum.beams += counts.beams;
      }
      EXPECT_GT(sum.at_origin, 500U);
      EXPECT_GT(sum.beams, 0U);
    }
  }
}

}  // namespace
}  // namespace beambench::accel::tile_beam

// Normals are perpendicular to the surface that was hit, and pictures distinguish hits from misses.

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "accel/core/registry.hpp"
#include "harness/rays/normal.hpp"
#include "harness/render/shading.hpp"
#include "scenes/base/error.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::render {
namespace {

glm::dvec3 arbitrary_point(double size) {
  const auto coordinate = [size] { return size * *rc::gen::inRange(-1000, 1001) / 1000.0; };
  const double x = coordinate();
  const double y = coordinate();
  return {x, y, coordinate()};
}

/// Returns the hit of a ray from `origin` toward `target`, by exhaustive search.
std::optional<accel::Hit> shoot(const scenes::Scene& scene, const accel::Ray& ray) {
  return accel::registry().choose({"exhaustive", {}}).build(scene)->closest_hit(ray, nullptr);
}

accel::Ray ray_toward(const glm::dvec3& origin, const glm::dvec3& target) {
  accel::Ray ray;
  ray.origin = glm::vec3(origin);
  ray.direction = glm::vec3(target - origin);
  return ray;
}

glm::dvec3 point_at(const accel::Ray& ray, const accel::Hit& hit) {
  return glm::dvec3(ray.origin) + double{hit.t} * glm::dvec3(ray.direction);
}

/// Requires a vector to be perpendicular to a direction, to float accuracy of the hit.
void require_upright(const glm::dvec3& normal, const glm::dvec3& tangent) {
  RC_ASSERT(std::abs(glm::dot(normal, glm::normalize(tangent))) < 1e-4);
}

void require_unit_and_facing(const glm::dvec3& normal, const accel::Ray& ray) {
  RC_ASSERT(std::abs(glm::length(normal) - 1.0) < 1e-12);
  RC_ASSERT(glm::dot(normal, glm::dvec3(ray.direction)) <= 0.0);
}

RC_GTEST_PROP(GeometricNormal, OfASpherePointsAlongTheRadiusFromOutsideAndInside, ()) {
  scenes::SceneBuilder builder("one sphere");
  const glm::dvec3 center = arbitrary_point(1.0);
  builder.add_sphere(center, 2.0);
  const scenes::Scene scene = std::move(builder).build();
  const double distance = *rc::gen::element(0.5, 10.0);
  const glm::dvec3 origin = center + glm::dvec3(distance, 0.3, 0.1);
  const accel::Ray ray = ray_toward(origin, center + arbitrary_point(0.3));
  const auto hit = shoot(scene, ray);
  RC_PRE(hit.has_value());
  const glm::dvec3 normal = rays::geometric_normal(scene, ray, *hit);
  require_unit_and_facing(normal, ray);
  const glm::dvec3 radius = glm::normalize(point_at(ray, *hit) - center);
  RC_ASSERT(std::abs(std::abs(glm::dot(normal, radius)) - 1.0) < 1e-5);
}

RC_GTEST_PROP(GeometricNormal, OfAConeIsUprightOnItsLinesAndItsCircles, ()) {
  const glm::dvec3 base(0.0);
  const glm::dvec3 apex(0.0, 0.0, 2.0);
  const double base_radius = *rc::gen::element(0.0, 0.4, 1.0);
  const double apex_radius = *rc::gen::element(0.2, 1.0, 1.7);
  scenes::SceneBuilder builder("one cone");
  builder.add_cone(base, base_radius, apex, apex_radius);
  const scenes::Scene scene = std::move(builder).build();
  const accel::Ray ray = ray_toward(glm::dvec3(5.0, 0.7, 1.1) + arbitrary_point(1.0),
                                    glm::dvec3(0.0, 0.0, 1.0) + arbitrary_point(0.3));
  const auto hit = shoot(scene, ray);
  RC_PRE(hit.has_value());
  const glm::dvec3 point = point_at(ray, *hit);
  const glm::dvec3 outward = glm::normalize(glm::dvec3(point.x, point.y, 0.0));
  const glm::dvec3 normal = rays::geometric_normal(scene, ray, *hit);
  require_unit_and_facing(normal, ray);
  require_upright(normal, (apex + outward * apex_radius) - (base + outward * base_radius));
  require_upright(normal, glm::cross(outward, apex - base));
}

RC_GTEST_PROP(GeometricNormal, OfABentPolygonIsThatOfTheTriangleHit, ()) {
  // Two triangles that meet along the diagonal: only the correct one has this normal.
  scenes::SceneBuilder builder("bent quadrilateral");
  const std::vector<glm::dvec3> corners{{0, 0, 0}, {1, 0, 0.4}, {1, 1, 0}, {0, 1, 0.4}};
  builder.add_polygon(corners);
  const scenes::Scene scene = std::move(builder).build();
  const accel::Ray ray =
      ray_toward({0.4, 0.6, 5.0}, glm::dvec3(0.5, 0.5, 0.2) + arbitrary_point(0.4));
  const auto hit = shoot(scene, ray);
  RC_PRE(hit.has_value());
  const glm::dvec3 point = point_at(ray, *hit);
  const glm::dvec3 normal = rays::geometric_normal(scene, ray, *hit);
  require_unit_and_facing(normal, ray);
  // With this normal, the plane through a corner of the triangle contains the point.
  int planes = 0;
  for (const scenes::Triangle& triangle : scene.triangles) {
    bool contains = true;
    for (const std::uint32_t vertex : triangle.vertex) {
      contains &= std::abs(glm::dot(point - glm::dvec3(scene.vertices[vertex]), normal)) < 1e-5;
    }
    planes += contains ? 1 : 0;
  }
  RC_ASSERT(planes >= 1);
}

TEST(ShadingNormal, OfASmoothPolygonRunsBetweenItsCorners) {
  scenes::SceneBuilder builder("smooth triangle");
  const std::vector<glm::dvec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<glm::dvec3> normals{{0, 0, 1}, {1, 0, 1}, {0, 0, 1}};
  builder.add_polygon(corners, normals);
  const scenes::Scene scene = std::move(builder).build();
  const accel::Ray ray = ray_toward({0.5, 0.25, 3.0}, {0.5, 0.25, 0.0});
  const accel::Hit hit = shoot(scene, ray).value();
  EXPECT_NEAR(glm::length(rays::geometric_normal(scene, ray, hit) - glm::dvec3(0, 0, 1)), 0.0,
              1e-6);
  // The point is halfway to the corner whose normal is tilted by 45 degrees.
  const double s = std::sqrt(0.5);
  const glm::dvec3 expected = glm::normalize(glm::dvec3(0.5 * s, 0.0, 0.5 + 0.5 * s));
  EXPECT_NEAR(glm::length(rays::shading_normal(scene, ray, hit) - expected), 0.0, 1e-6);
}

/// Returns a red sphere in front of a blue sky, seen down the z axis.
scenes::Scene red_ball() {
  scenes::SceneBuilder builder("red ball");
  builder.set_background({0.0, 0.0, 1.0});
  scenes::Surface red;
  red.color = {1.0F, 0.0F, 0.0F};
  builder.set_surface(red);
  builder.add_sphere({0, 0, 0}, 1.0);
  scenes::Camera camera;
  camera.from = {0.0F, 0.0F, 5.0F};
  camera.at = {0.0F, 0.0F, 0.0F};
  builder.add_camera(camera);
  return std::move(builder).build();
}

Image picture_of(const scenes::Scene& scene, Shading shading) {
  const accel::PrimaryRays rays(scene.cameras.front(), 33, 33, 1);
  accel::HitBuffer hits(33, 33, 1);
  accel::registry().choose({"exhaustive", {}}).build(scene)->closest_hits(rays, hits, {});
  return shade(scene, rays, hits, shading);
}

TEST(Shade, PreviewShowsTheSurfaceBeforeTheBackground) {
  const Image image = picture_of(red_ball(), Shading::kPreview);
  EXPECT_EQ(image.at(0, 0), glm::vec3(0.0F, 0.0F, 1.0F));
  EXPECT_GT(image.at(16, 16).x, 0.9F);
  EXPECT_EQ(image.at(16, 16).z, 0.0F);
  EXPECT_GT(image.at(16, 16).x, image.at(24, 16).x) << "it gets darker toward the rim";
}

TEST(Shade, NormalsFaceTheEyeInTheMiddleOfABall) {
  const Image image = picture_of(red_ball(), Shading::kNormals);
  EXPECT_EQ(image.at(0, 0), glm::vec3(0.0F));
  EXPECT_NEAR(image.at(16, 16).z, 1.0F, 1e-3F);
  EXPECT_GT(image.at(22, 16).x, image.at(10, 16).x) << "x points to the right";
  EXPECT_GT(image.at(16, 10).y, image.at(16, 22).y) << "y points up";
}

TEST(Shade, DepthIsBrightestWhereItIsNearest) {
  const Image image = picture_of(red_ball(), Shading::kDepth);
  EXPECT_EQ(image.at(0, 0), glm::vec3(0.0F));
  EXPECT_GT(image.at(16, 16).x, image.at(22, 16).x);
  EXPECT_GT(image.at(22, 16).x, 0.0F);
}

TEST(Shade, AnUnknownNameIsRefusedWithTheValidOnes) {
  try {
    parse_shading("whited");
    FAIL() << "nothing thrown";
  } catch (const InputError& error) {
    for (const std::string_view name : shading_names()) {
      EXPECT_NE(std::string_view(error.what()).find(name), std::string_view::npos) << name;
    }
  }
}

}  // namespace
}  // namespace beambench::render

// The canonical ray-primitive tests.

#include "accel/core/intersect.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "scenes/catalogue.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

Ray ray(glm::vec3 origin, glm::vec3 direction, float t_min = 0.0F, float t_max = kInfinity) {
  return {origin, t_min, direction, t_max};
}

std::optional<float> hit_or_none(float t) { return is_hit(t) ? std::optional(t) : std::nullopt; }

std::optional<float> hit(const scenes::Sphere& sphere, const Ray& query) {
  return hit_or_none(intersect_sphere(CanonicalRay(query), sphere));
}
std::optional<float> hit(const scenes::Cone& cone, const Ray& query) {
  return hit_or_none(intersect_cone(CanonicalRay(query), cone));
}

const scenes::Sphere kUnitSphere{{0, 0, 0}, 1.0F, false};

TEST(IntersectSphere, NearRootThenFarRoot) {
  EXPECT_EQ(hit(kUnitSphere, ray({0, 0, 3}, {0, 0, -1})), 2.0F);
  EXPECT_EQ(hit(kUnitSphere, ray({0, 0, 0}, {0, 0, -1})), 1.0F);
  EXPECT_EQ(hit(kUnitSphere, ray({0, 0, 3}, {0, 0, -2})), 1.0F)
      << "t is in units of the direction's length";
  EXPECT_EQ(hit(kUnitSphere, ray({0, 0, 3}, {0, 0, 1})), std::nullopt);
  EXPECT_EQ(hit(kUnitSphere, ray({0, 1, 3}, {0, 0, -1})), 3.0F) << "tangent";
  EXPECT_EQ(hit(kUnitSphere, ray({0, 1.0001F, 3}, {0, 0, -1})), std::nullopt);
}

TEST(IntersectSphere, IntervalIsClosed) {
  EXPECT_EQ(hit(kUnitSphere, ray({0, 0, 3}, {0, 0, -1}, 2.0F, 2.0F)), 2.0F);
  EXPECT_EQ(hit(kUnitSphere, ray({0, 0, 3}, {0, 0, -1}, 2.5F, 4.0F)), 4.0F);
  EXPECT_EQ(hit(kUnitSphere, ray({0, 0, 3}, {0, 0, -1}, 2.5F, 3.5F)), std::nullopt);
  EXPECT_EQ(hit(kUnitSphere, ray({0, 0, 1}, {0, 0, 1})), 0.0F) << "from its surface";
}

TEST(IntersectSphere, InsideOnlyIsHitWhereTheRayLeaves) {
  const scenes::Sphere inside{{0, 0, 0}, 1.0F, true};
  EXPECT_EQ(hit(inside, ray({0, 0, 3}, {0, 0, -1})), 4.0F);
  EXPECT_EQ(hit(inside, ray({0, 0, 3}, {0, 0, -1}, 0.0F, 3.0F)), std::nullopt);
}

TEST(IntersectCone, CylinderBothWallsNoCaps) {
  const scenes::Cone cylinder{{0, 0, 0}, 1.0F, {0, 0, 2}, 1.0F, false};
  EXPECT_EQ(hit(cylinder, ray({3, 0, 1}, {-1, 0, 0})), 2.0F);
  EXPECT_EQ(hit(cylinder, ray({0, 0, 1}, {-1, 0, 0})), 1.0F);
  EXPECT_EQ(hit(cylinder, ray({0, 0, 5}, {0, 0, -1})), std::nullopt) << "down the open end";
  EXPECT_EQ(hit(cylinder, ray({3, 0, 2.001F}, {-1, 0, 0})), std::nullopt);
  // The ray enters over the rim and exits through the far wall.
  EXPECT_EQ(hit(cylinder, ray({1.5F, 0, 3}, {-1, 0, -1})), 2.5F);
}

TEST(IntersectCone, TaperedTipAndInsideOnly) {
  const scenes::Cone cone{{0, 0, 0}, 1.0F, {0, 0, 1}, 0.0F, false};
  EXPECT_EQ(hit(cone, ray({2, 0, 0.5F}, {-1, 0, 0})), 1.5F);
  EXPECT_EQ(hit(cone, ray({2, 0, 1.5F}, {-1, 0, 0})), std::nullopt) << "the other nappe";
  EXPECT_EQ(hit(cone, ray({2, 0, -0.5F}, {-1, 0, 0})), std::nullopt) << "below the base";
  // Parallel to one generator: the quadratic is linear.
  EXPECT_EQ(hit(cone, ray({-1, 0, 0.5F}, {1, 0, -1})), 0.25F);
  EXPECT_EQ(hit(cone, ray({2, 0, -0.5F}, {-1, 0, 1})), std::nullopt) << "along the far generator";
  const scenes::Cone inside{{0, 0, 0}, 1.0F, {0, 0, 1}, 0.5F, true};
  EXPECT_EQ(hit(inside, ray({2, 0, 0.5F}, {-1, 0, 0})), 2.75F);
}

TEST(IntersectTriangle, ClosedEdgesBothSides) {
  const glm::vec3 a(0, 0, 0);
  const glm::vec3 b(1, 0, 0);
  const glm::vec3 c(0, 1, 0);
  const auto t = [&](const Ray& query) {
    return hit_or_none(intersect_triangle(CanonicalRay(query), a, b, c));
  };
  EXPECT_EQ(t(ray({0.25F, 0.25F, 2}, {0, 0, -1})), 2.0F);
  EXPECT_EQ(t(ray({0.25F, 0.25F, -2}, {0, 0, 1})), 2.0F);
  EXPECT_EQ(t(ray({0.5F, 0.5F, 2}, {0, 0, -1})), 2.0F) << "on an edge";
  EXPECT_EQ(t(ray({1, 0, 2}, {0, 0, -1})), 2.0F) << "on a vertex";
  EXPECT_EQ(t(ray({0.51F, 0.5F, 2}, {0, 0, -1})), std::nullopt);
  EXPECT_EQ(t(ray({-1, 0.25F, 0}, {1, 0, 0})), std::nullopt) << "in its plane";
  EXPECT_EQ(t(ray({0.25F, 0.25F, 0}, {0, 0, -1})), 0.0F) << "from its surface";
}

TEST(IntersectTriangle, ClosedMeshIsWatertight) {
  const scenes::Scene scene = scenes::load_scene("bumpy:triangles=768");
  const auto any = [&](const CanonicalRay& query) {
    for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
      if (is_hit(intersect(query, scene, id))) return true;
    }
    return false;
  };
  Random random(1);
  for (int i = 0; i < 4'000; ++i) {
    // From the inside, aimed exactly at a vertex or the middle of an edge: some triangle must stop
    // the ray.
    const glm::vec3 eye{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3),
                        random.uniform(-0.3, 0.3)};
    const scenes::Triangle& triangle = scene.triangles[random.below(scene.triangles.size())];
    const glm::vec3 v0 = scene.vertices[triangle.vertex[0]];
    const glm::vec3 v1 = scene.vertices[triangle.vertex[1]];
    const glm::vec3 target = random.below(2) == 0 ? v0 : (v0 + v1) * 0.5F;
    EXPECT_TRUE(any(CanonicalRay(ray(eye, target - eye)))) << i;
  }
}

/// Returns the distance of a point from a sphere's or cone's surface or a polygon's triangles, in
/// double.
double distance_to_triangle(const glm::dvec3& p, const glm::dvec3 (&v)[3]) {
  const glm::dvec3 normal = glm::normalize(glm::cross(v[1] - v[0], v[2] - v[0]));
  bool above = true;
  double nearest_edge = INFINITY;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 edge = v[(i + 1) % 3] - v[i];
    above = above && glm::dot(glm::cross(normal, edge), p - v[i]) >= 0.0;
    const double along = std::clamp(glm::dot(p - v[i], edge) / glm::dot(edge, edge), 0.0, 1.0);
    nearest_edge = std::min(nearest_edge, glm::length(p - (v[i] + edge * along)));
  }
  return above ? std::min(nearest_edge, std::abs(glm::dot(normal, p - v[0]))) : nearest_edge;
}

double distance_to(const scenes::Scene& scene, scenes::PrimitiveId id, const glm::dvec3& p) {
  const scenes::Primitive& primitive = scene.primitives[id];
  if (primitive.kind == scenes::PrimitiveKind::kSphere) {
    const scenes::Sphere& sphere = scene.spheres[primitive.index];
    return std::abs(glm::length(p - glm::dvec3(sphere.center)) - sphere.radius);
  }
  if (primitive.kind == scenes::PrimitiveKind::kCone) {
    const scenes::Cone& cone = scene.cones[primitive.index];
    const glm::dvec3 axis = glm::dvec3(cone.apex) - glm::dvec3(cone.base);
    const glm::dvec3 m = p - glm::dvec3(cone.base);
    const double s = glm::dot(m, axis) / glm::dot(axis, axis);
    const double taper = static_cast<double>(cone.apex_radius) - cone.base_radius;
    const double radius = cone.base_radius + s * taper;
    const double slant = taper / glm::length(axis);
    const double beyond = std::max({-s, s - 1.0, 0.0}) * glm::length(axis);
    // Both values are lower bounds of the distance from the surface.
    return std::max(std::abs(glm::length(m - axis * s) - radius) / std::hypot(1.0, slant), beyond);
  }
  const scenes::Polygon& polygon = scene.polygons[primitive.index];
  double nearest = INFINITY;
  for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
    const auto& vertex = scene.triangles[polygon.first_triangle + i].vertex;
    nearest = std::min(nearest, distance_to_triangle(p, {glm::dvec3(scene.vertices[vertex[0]]),
                                                         glm::dvec3(scene.vertices[vertex[1]]),
                                                         glm::dvec3(scene.vertices[vertex[2]])}));
  }
  return nearest;
}

RC_GTEST_PROP(Intersect, PointAtTheHitLiesOnThePrimitive, (std::uint32_t seed)) {
  const scenes::Scene scene = tests::random_scene(seed, 12);
  Random random(seed);
  for (int i = 0; i < 100; ++i) {
    const Ray query = tests::random_ray(scene, random);
    const CanonicalRay canonical(query);
    const double diagonal = glm::length(glm::dvec3(scene.bounds.extent()));
    for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
      const float t = intersect(canonical, scene, id);
      if (!is_hit(t)) continue;
      RC_ASSERT(t >= query.t_min);
      RC_ASSERT(t <= query.t_max);
      const double rounding = 0x1p-24 * t * glm::length(canonical.direction);
      RC_ASSERT(distance_to(scene, id, canonical.at(t)) <= rounding + 0x1p-30 * diagonal);
    }
  }
}

}  // namespace
}  // namespace beambench::accel

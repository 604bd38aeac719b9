// Box-primitive overlap: no false negatives where a hit is possible, and few false positives.

#include "accel/core/overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "accel/core/intersect.hpp"
#include "accel/core/tolerance.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

Box cube(double x, double y, double z, double half) {
  return {glm::dvec3(x, y, z) - half, glm::dvec3(x, y, z) + half};
}

TEST(OverlapSphere, TestsTheSurfaceNotTheSolid) {
  const scenes::Sphere sphere{{0, 0, 0}, 1.0F, false};
  EXPECT_FALSE(sphere_overlaps(sphere, cube(0, 0, 0, 0.5), 0.0)) << "box wholly inside";
  EXPECT_TRUE(sphere_overlaps(sphere, cube(0, 0, 0, 0.6), 0.0)) << "its corners stick out";
  EXPECT_TRUE(sphere_overlaps(sphere, cube(0, 0, 0, 3.0), 0.0)) << "sphere wholly inside";
  EXPECT_TRUE(sphere_overlaps(sphere, cube(2, 0, 0, 1.0), 0.0)) << "touches in one point";
  EXPECT_FALSE(sphere_overlaps(sphere, cube(2, 0, 0, 0.999), 0.0));
  EXPECT_TRUE(sphere_overlaps(sphere, cube(2, 0, 0, 0.999), 0.01)) << "widened";
  EXPECT_FALSE(sphere_overlaps(sphere, cube(0.9, 0.9, 0.9, 0.3), 0.0)) << "beside a corner";
}

TEST(OverlapTriangle, EveryKindOfSeparation) {
  const std::array<glm::dvec3, 3> triangle{glm::dvec3(0, 0, 0), {2, 0, 0}, {0, 2, 0}};
  EXPECT_TRUE(triangle_overlaps(triangle, cube(0.5, 0.5, 0, 0.1), 0.0)) << "pierced by its inside";
  EXPECT_TRUE(triangle_overlaps(triangle, cube(0, 0, 0, 5), 0.0)) << "wholly inside";
  EXPECT_TRUE(triangle_overlaps(triangle, cube(3, 0, 0, 1), 0.0)) << "touches a vertex";
  EXPECT_FALSE(triangle_overlaps(triangle, cube(3, 0, 0, 0.99), 0.0)) << "by a face plane";
  EXPECT_FALSE(triangle_overlaps(triangle, cube(1.5, 1.5, 0, 0.4), 0.0)) << "by an edge plane";
  EXPECT_FALSE(triangle_overlaps(triangle, cube(0.5, 0.5, 1, 0.9), 0.0)) << "by its own plane";
}

TEST(OverlapPolygon, TheNotchOfAConcavePolygonIsEmpty) {
  scenes::SceneBuilder builder("arrow");
  const glm::dvec3 corners[] = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}};
  builder.add_polygon(corners);
  const scenes::Scene scene = std::move(builder).build();
  EXPECT_FALSE(surface_overlaps(scene, 0, cube(2, 3, 0, 0.3), 0.0));
  EXPECT_TRUE(surface_overlaps(scene, 0, cube(2, 1, 0, 0.3), 0.0));
  EXPECT_TRUE(surface_overlaps(scene, 0, cube(0.3, 3, 0, 0.2), 0.0));
}

TEST(OverlapCone, HollowAndOpen) {
  const scenes::Cone cylinder{{0, 0, 0}, 1.0F, {0, 0, 4}, 1.0F, false};
  EXPECT_TRUE(cone_overlaps(cylinder, cube(1, 0, 2, 0.1), 0.0));
  EXPECT_FALSE(cone_overlaps(cylinder, cube(0, 0, 2, 0.3), 0.0)) << "inside";
  EXPECT_FALSE(cone_overlaps(cylinder, cube(0, 0, 5, 0.5), 0.0)) << "beyond an end";
  EXPECT_FALSE(cone_overlaps(cylinder, cube(3, 0, 2, 0.5), 0.0)) << "far from the axis";
}

/// Returns a random box around a point, which may lie on the box's boundary.
Box box_with(const glm::dvec3& point, Random& random) {
  Box box{point, point};
  for (int axis = 0; axis < 3; ++axis) {
    const double size = std::exp(random.uniform(-6.0, 1.0));
    const double below = random.below(3) == 0 ? 0.0 : random.uniform(0.0, size);
    box.lower[axis] -= below;
    box.upper[axis] += size - below;
  }
  return box;
}

RC_GTEST_PROP(Overlap, NeverFalseWhereAHitIs, (std::uint32_t seed)) {
  const scenes::Scene scene = tests::random_scene(seed, 10);
  const double tolerance = overlap_tolerance(scene);
  Random random(seed);
  for (int i = 0; i < 100; ++i) {
    const Ray ray = tests::random_ray(scene, random);
    CanonicalRay canonical(ray);
    for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
      const float t = intersect(canonical, scene, id);
      if (!is_hit(t)) continue;
      // The point at the rounded t: widen by that rounding, because the traversal uses the
      // unrounded t.
      const double rounding = 0x1p-24 * t * glm::length(canonical.direction);
      const Box box = box_with(canonical.at(t), random);
      RC_ASSERT(surface_overlaps(scene, id, box, tolerance + rounding));
    }
  }
}

/// Clips a triangle against the six planes of a box (Sutherland and Hodgman 1974). Returns whether
/// any of it remains.
bool clipped_triangle_remains(const std::array<glm::dvec3, 3>& corners, const Box& box) {
  std::vector<glm::dvec3> polygon(corners.begin(), corners.end());
  for (int plane = 0; plane < 6 && !polygon.empty(); ++plane) {
    const int axis = plane / 2;
    const auto inside = [&](const glm::dvec3& p) {
      return plane % 2 == 0 ? p[axis] - box.lower[axis] : box.upper[axis] - p[axis];
    };
    std::vector<glm::dvec3> clipped;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const glm::dvec3& a = polygon[i];
      const glm::dvec3& b = polygon[(i + 1) % polygon.size()];
      const double da = inside(a);
      const double db = inside(b);
      if (da >= 0.0) clipped.push_back(a);
      if ((da < 0.0) != (db < 0.0)) clipped.push_back(a + (b - a) * (da / (da - db)));
    }
    polygon = std::move(clipped);
  }
  return !polygon.empty();
}

RC_GTEST_PROP(OverlapTriangle, AgreesWithClipping, (std::uint32_t seed)) {
  Random random(seed);
  const auto point = [&] {
    return glm::dvec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  };
  for (int i = 0; i < 200; ++i) {
    const std::array<glm::dvec3, 3> corners{point(), point(), point()};
    const Box box = box_with(point(), random);
    constexpr double kBand = 1e-9;  // width in which clipping itself may be wrong
    Box smaller{box.lower + kBand, box.upper - kBand};
    if (clipped_triangle_remains(corners, smaller)) {
      RC_ASSERT(triangle_overlaps(corners, box, 0.0));
    }
    Box larger{box.lower - kBand, box.upper + kBand};
    if (!clipped_triangle_remains(corners, larger)) {
      RC_ASSERT(!triangle_overlaps(corners, box, 0.0));
    }
  }
}

TEST(SameSurface, HoldsOnlyForEqualNumbers) {
  scenes::SceneBuilder builder("pairs");
  const std::vector<glm::dvec3> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  std::vector<glm::dvec3> moved = corners;
  moved[2].z = 0.5;
  for (int i = 0; i < 2; ++i) {
    builder.add_sphere({1, 2, 3}, 2);
    builder.add_cone({0, 0, 0}, 0.5, {1, 1, 1}, 0.2);
    builder.add_polygon(corners);
  }
  builder.add_sphere({1, 2, 3}, 2.5);
  builder.add_cone({0, 0, 0}, 0.5, {1, 1, 1}, 0.25);
  builder.add_polygon(moved);
  const scenes::Scene scene = std::move(builder).build();
  for (scenes::PrimitiveId a = 0; a < 9; ++a) {
    for (scenes::PrimitiveId b = 0; b < 9; ++b) {
      EXPECT_EQ(same_surface(scene, a, b), a == b || (a < 6 && b < 6 && a % 3 == b % 3))
          << a << " and " << b;
    }
  }
}

}  // namespace
}  // namespace beambench::accel

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "scenes/base/random.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/scenes/thrown_message.hpp"

namespace beambench::scenes {
namespace {

using Points = std::vector<glm::dvec3>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Points kTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

/// Returns the message with which a builder that already holds one sphere refuses an addition.
template <typename Add>
std::string refusal(Add add) {
  SceneBuilder builder("test");
  builder.add_sphere({0, 0, 0}, 1.0);
  const std::string message = thrown_message([&] { add(builder); });
  EXPECT_EQ(builder.primitive_count(), 1U) << "a refused primitive was kept: " << message;
  return message;
}

TEST(SceneBuilder, RefusesBadSpheres) {
  EXPECT_TRUE(says(refusal([](SceneBuilder& b) {
                     b.add_sphere({0, kNan, 0}, 1.0);
                   }),
                   {"sphere (primitive 1)", "center", "nan"}));
  EXPECT_TRUE(says(refusal([](SceneBuilder& b) {
                     b.add_sphere({0, 0, -kInfinity}, 1.0);
                   }),
                   {"-inf"}));
  EXPECT_TRUE(says(refusal([](SceneBuilder& b) { b.add_sphere({2e9, 0, 0}, 1.0); }), {"1e9"}));
  EXPECT_TRUE(says(refusal([](SceneBuilder& b) { b.add_sphere({0, 0, 0}, 1e300); }), {"radius"}));
  for (const double radius : {0.0, -0.0, 1e-60}) {
    EXPECT_TRUE(says(refusal([&](SceneBuilder& b) {
                       b.add_sphere({0, 0, 0}, radius);
                     }),
                     {"sphere (primitive 1)", "radius is 0"}));
  }
}

TEST(SceneBuilder, RefusesBadCones) {
  const auto cone = [](double base_radius, double apex_radius, const glm::dvec3& apex) {
    return refusal([&](SceneBuilder& b) { b.add_cone({1, 2, 3}, base_radius, apex, apex_radius); });
  };
  EXPECT_TRUE(says(cone(0, 0, {1, 2, 4}), {"cone (primitive 1)", "both radii are 0"}));
  EXPECT_TRUE(says(cone(1, -1, {1, 2, 4}), {"differ in sign"}));
  EXPECT_TRUE(says(cone(1, 1, {1, 2, 3.0 + 1e-9}), {"same point"}));
  EXPECT_TRUE(says(cone(1, kNan, {1, 2, 4}), {"apex radius is nan"}));
  EXPECT_TRUE(says(cone(1, 1, {1, kInfinity, 4}), {"apex is inf"}));
}

TEST(SceneBuilder, RefusesBadPolygons) {
  const auto polygon = [](const Points& corners, const Points& normals = {}) {
    return refusal([&](SceneBuilder& b) { b.add_polygon(corners, normals); });
  };
  EXPECT_TRUE(says(polygon({{0, 0, 0}, {1, 0, 0}}), {"polygon (primitive 1)", "at least 3"}));
  EXPECT_TRUE(says(polygon({{0, 0, 0}, {1, 0, 0}, {1, 0, 1e-60}, {0, 0, 0}}), {"only 2 of its 4"}));
  EXPECT_TRUE(says(polygon({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}), {"no area"}));
  EXPECT_TRUE(says(polygon({{0, 0, 0}, {1, kNan, 1}, {2, 2, 2}}), {"corner is nan"}));
  EXPECT_TRUE(says(polygon(kTriangle, {{0, 0, 1}}), {"1 normals for 3 corners"}));
  EXPECT_TRUE(says(polygon(kTriangle, {{0, 0, 1}, {0, kNan, 1}, {0, 0, 1}}), {"normal is nan"}));
  EXPECT_TRUE(says(refusal([](SceneBuilder& b) {
                     b.add_polygon(std::vector<std::uint32_t>{0, 1, 2});
                   }),
                   {"there are only 0 vertices"}));
}

TEST(SceneBuilder, RefusesBadCameras) {
  const auto camera = [](auto change) {
    return refusal([&](SceneBuilder& b) {
      Camera c;
      change(c);
      b.add_camera(c);
    });
  };
  EXPECT_TRUE(says(camera([](Camera& c) { c.angle = 180.0F; }), {"between 0 and 180"}));
  EXPECT_TRUE(says(camera([](Camera& c) { c.angle = std::nanf(""); }), {"angle is nan"}));
  EXPECT_TRUE(says(camera([](Camera& c) { c.at = c.from; }), {"the eye is the point"}));
  EXPECT_TRUE(says(camera([](Camera& c) { c.up = c.at - c.from; }), {"parallel to the view"}));
  EXPECT_TRUE(says(camera([](Camera& c) { c.up = {0, 0, 0}; }), {"up vector is 0"}));
  EXPECT_TRUE(says(camera([](Camera& c) { c.width = 0; }), {"0 x 512"}));
  EXPECT_TRUE(says(camera([](Camera& c) { c.aspect = 0.0F; }), {"aspect"}));
  for (const char* name : {"", " side", "side ", "two\nlines", "a\tb", "#1"}) {
    EXPECT_TRUE(says(camera([&](Camera& c) { c.name = name; }), {"camera 0", "name"})) << name;
  }
}

TEST(SceneBuilder, RefusesBadSurfacesLightsAndBackgrounds) {
  EXPECT_TRUE(says(refusal([](SceneBuilder& b) { b.set_surface({.diffuse = std::nanf("")}); }),
                   {"factor is nan"}));
  EXPECT_TRUE(says(refusal([](SceneBuilder& b) {
                     b.add_light({0, 0, kInfinity});
                   }),
                   {"light 0", "position"}));
  EXPECT_TRUE(says(refusal([](SceneBuilder& b) {
                     b.set_background({0, kNan, 0});
                   }),
                   {"background"}));
  EXPECT_TRUE(says(refusal([](SceneBuilder& b) { b.add_vertex({0, kNan, 0}); }), {"vertex 0"}));
}

TEST(SceneBuilder, NegativeRadiusMeansInsideOnly) {
  SceneBuilder builder("test");
  builder.add_sphere({0, 0, 0}, -2.0);
  builder.add_cone({0, 0, 0}, -1.0, {0, 0, 1}, -0.5);
  builder.add_cone({0, 0, 0}, 0.0, {0, 0, 1}, 0.5);
  const Scene scene = std::move(builder).build();
  EXPECT_TRUE(scene.spheres[0].inside_only);
  EXPECT_EQ(scene.spheres[0].radius, 2.0F);
  EXPECT_TRUE(scene.cones[0].inside_only);
  EXPECT_EQ(scene.cones[0].apex_radius, 0.5F);
  EXPECT_FALSE(scene.cones[1].inside_only);
}

TEST(SceneBuilder, MergesConsecutiveCornersAtTheSamePlace) {
  SceneBuilder builder("test");
  builder.add_polygon(Points{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {0, 0, 0}},
                      Points{{0, 0, 1}, {1, 1, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 1}, {1, 1, 1}});
  const Scene scene = std::move(builder).build();
  ASSERT_EQ(scene.polygons[0].corner_count, 3U);
  EXPECT_EQ(scene.polygons[0].triangle_count, 1U);
  ASSERT_EQ(scene.normals.size(), 3U);
  EXPECT_EQ(scene.normals[1], glm::vec3(0, 1, 1));
}

TEST(SceneBuilder, ReplacesNormalsOfLengthZero) {
  SceneBuilder builder("test");
  builder.add_polygon(kTriangle, Points(3, glm::dvec3(0.0)));
  const Scene scene = std::move(builder).build();
  for (const glm::vec3& normal : scene.normals) EXPECT_EQ(normal, glm::vec3(0, 0, 1));
}

TEST(SceneBuilder, SharedVerticesAreShared) {
  SceneBuilder builder("test");
  for (const glm::dvec3& point : Points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}) {
    builder.add_vertex(point);
  }
  builder.add_polygon(std::vector<std::uint32_t>{0, 1, 2});
  builder.add_polygon(std::vector<std::uint32_t>{0, 2, 3});
  const Scene scene = std::move(builder).build();
  EXPECT_EQ(scene.vertices.size(), 4U);
  EXPECT_EQ(scene.polygons[1].first_normal, Polygon::kFlat);
  EXPECT_EQ(scene.triangles[1].primitive, 1U);
  EXPECT_EQ(scene.triangles[1].vertex[2], 3U);
}

TEST(SceneBuilder, ConcavePolygonOwnsAllItsTriangles) {
  SceneBuilder builder("test");
  builder.add_sphere({0, 0, 0}, 1.0);
  builder.add_polygon(Points{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}});
  const Scene scene = std::move(builder).build();
  EXPECT_EQ(scene.polygons[0].triangle_count, 3U);
  for (const Triangle& triangle : scene.triangles) EXPECT_EQ(triangle.primitive, 1U);
}

TEST(SceneBuilder, SurfacesFollowTheirPrimitives) {
  SceneBuilder builder("test");
  builder.add_sphere({0, 0, 0}, 1.0);
  builder.set_surface({.color = {1, 0, 0}});
  builder.set_surface({.color = {0, 1, 0}});
  builder.add_sphere({0, 0, 0}, 1.0);
  builder.set_surface({.color = {0, 1, 0}});
  builder.add_sphere({0, 0, 0}, 1.0);
  builder.set_surface({.color = {0, 0, 1}});
  builder.set_surface({.color = {0, 1, 0}});
  builder.add_sphere({0, 0, 0}, 1.0);
  const Scene scene = std::move(builder).build();
  ASSERT_EQ(scene.surfaces.size(), 2U) << "unused and repeated surfaces are left out";
  EXPECT_EQ(scene.surfaces[scene.primitives[0].surface].color, glm::vec3(1, 1, 1));
  EXPECT_EQ(scene.surfaces[scene.primitives[2].surface].color, glm::vec3(0, 1, 0));
}

TEST(SceneBuilder, RefusedPolygonLeavesNoVerticesBehind) {
  SceneBuilder builder("test");
  EXPECT_THROW(builder.add_polygon(Points{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}), InputError);
  builder.add_polygon(kTriangle);
  EXPECT_EQ(std::move(builder).build().vertices.size(), 3U);
}

TEST(SceneBuilder, FittedCameraSeesAllCorners) {
  SceneBuilder builder("test");
  builder.add_sphere({100, 0, 0}, 5.0);
  builder.add_sphere({-20, 7, 30}, 1.0);
  const Scene scene = std::move(builder).build();
  ASSERT_EQ(scene.cameras.size(), 1U);
  const Camera& camera = scene.cameras[0];
  const glm::vec3 forward = glm::normalize(camera.at - camera.from);
  const float min_cosine = std::cos(glm::radians(0.5F * camera.angle)) - 1e-5F;
  for (int corner = 0; corner < 8; ++corner) {
    glm::vec3 point = scene.bounds.lower;
    for (int axis = 0; axis < 3; ++axis) {
      if ((corner >> axis & 1) != 0) point[axis] = scene.bounds.upper[axis];
    }
    EXPECT_GE(glm::dot(glm::normalize(point - camera.from), forward), min_cosine);
  }
}

TEST(SceneBuilder, FittedEyeStaysWithinTheLimit) {
  for (const double place : {-1e9, -5e8, 0.0, 5e8, 1e9}) {
    for (const double radius : {1e-3, 1e6, 1e9}) {
      SceneBuilder builder("test");
      builder.add_sphere({place, -place, place}, radius);
      const Camera camera = std::move(builder).build().cameras[0];
      SceneBuilder again("again");
      EXPECT_NO_THROW(again.add_camera(camera)) << place << ' ' << radius;
    }
  }
}

TEST(SceneBuilder, RefusesASceneBelowTheMinimumExtent) {
  const auto built = [](double size) {
    SceneBuilder builder("small");
    builder.add_polygon(Points{{0, 0, 0}, {size, 0, 0}, {0, size, 0}});
    return std::move(builder).build();
  };
  EXPECT_NO_THROW(built(1e-9));
  EXPECT_TRUE(says(thrown_message([&] { built(5e-10); }),
                   {"'small'", "7.07e-10", "at least 1e-09", "scale it up"}));
  EXPECT_TRUE(says(thrown_message([&] { built(1e-16); }), {"1.41e-16", "scale it up"}));

  // Small primitives are valid in a scene that is large enough.
  SceneBuilder builder("mixed");
  builder.add_sphere({0, 0, 0}, 1e-12);
  builder.add_sphere({0, 0, 0}, 1.0);
  EXPECT_NO_THROW(std::move(builder).build());
}

TEST(SceneBuilder, EmptySceneHasACameraAndNoBounds) {
  const Scene scene = SceneBuilder("test").build();
  EXPECT_TRUE(scene.bounds.empty());
  EXPECT_EQ(scene.cameras.size(), 1U);
}

glm::dvec3 random_point(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

RC_GTEST_PROP(PrimitiveBounds, OfASphereAreTheTightestOutside, (std::uint64_t seed)) {
  Random random(seed);
  SceneBuilder builder("test");
  builder.add_sphere(random_point(random, std::exp(random.uniform(-20, 20))),
                     std::exp(random.uniform(-20, 20)));
  const Scene scene = std::move(builder).build();
  const Sphere sphere = scene.spheres[0];
  for (int axis = 0; axis < 3; ++axis) {
    // The 64-bit mantissa makes these sums exact for all but the most unequal operands.
    const long double low = static_cast<long double>(sphere.center[axis]) - sphere.radius;
    const long double high = static_cast<long double>(sphere.center[axis]) + sphere.radius;
    RC_ASSERT(scene.bounds.lower[axis] <= low);
    RC_ASSERT(std::nextafter(scene.bounds.lower[axis], 1e10F) > low);
    RC_ASSERT(scene.bounds.upper[axis] >= high);
    RC_ASSERT(std::nextafter(scene.bounds.upper[axis], -1e10F) < high);
  }
}

TEST(PrimitiveBounds, RoundOutwardWhereEvenDoubleIsTooCoarse) {
  SceneBuilder builder("test");
  builder.add_sphere({1e9, -1e9, 0}, 1e-9);
  const Bounds bounds = std::move(builder).build().bounds;
  EXPECT_LT(bounds.lower.x, 1e9F);
  EXPECT_GT(bounds.upper.x, 1e9F);
  EXPECT_LT(bounds.lower.y, -1e9F);
  EXPECT_GT(bounds.upper.y, -1e9F);
}

RC_GTEST_PROP(PrimitiveBounds, OfAConeHoldItsRims, (std::uint64_t seed)) {
  Random random(seed);
  SceneBuilder builder("test");
  builder.add_cone(random_point(random, 5), random.uniform(0, 2), random_point(random, 5),
                   random.uniform(0, 2));
  const Scene scene = std::move(builder).build();
  const Cone& cone = scene.cones[0];
  const glm::dvec3 axis = glm::normalize(glm::dvec3(cone.apex) - glm::dvec3(cone.base));
  const glm::dvec3 side = std::abs(axis.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(axis, side));
  const glm::dvec3 v = glm::cross(axis, u);
  Bounds rims;
  for (int i = 0; i < 3600; ++i) {
    const double angle = glm::radians(0.1 * i);
    const glm::dvec3 out = std::cos(angle) * u + std::sin(angle) * v;
    for (const glm::dvec3& point :
         {glm::dvec3(cone.base) + out * static_cast<double>(cone.base_radius),
          glm::dvec3(cone.apex) + out * static_cast<double>(cone.apex_radius)}) {
      rims.include(glm::vec3(point));
      for (int k = 0; k < 3; ++k) {
        RC_ASSERT(point[k] >= scene.bounds.lower[k] - 1e-14);
        RC_ASSERT(point[k] <= scene.bounds.upper[k] + 1e-14);
      }
    }
  }
  RC_ASSERT(glm::length(rims.lower - scene.bounds.lower) < 1e-4F);
  RC_ASSERT(glm::length(rims.upper - scene.bounds.upper) < 1e-4F);
}

TEST(PrimitiveBounds, OfAnUprightCylinderEndAtItsRims) {
  SceneBuilder builder("test");
  builder.add_cone({0, 0, 1}, 2.0, {0, 0, 5}, 2.0);
  const Bounds bounds = std::move(builder).build().bounds;
  EXPECT_EQ(bounds.lower.z, 1.0F);
  EXPECT_EQ(bounds.upper.z, 5.0F);
}

std::uint64_t hash_of(const Points& corners, double radius) {
  SceneBuilder builder("test");
  builder.add_polygon(corners);
  builder.add_sphere({0, 0, 0}, radius);
  return scene_hash(std::move(builder).build());
}

TEST(SceneHash, ChangesWithGeometryOnly) {
  const std::uint64_t hash = hash_of(kTriangle, 1.0);
  EXPECT_EQ(hash_of(kTriangle, 1.0), hash);
  EXPECT_NE(hash_of(kTriangle, -1.0), hash);
  EXPECT_NE(hash_of(kTriangle, std::nextafter(1.0F, 2.0F)), hash);
  EXPECT_NE(hash_of({kTriangle[1], kTriangle[2], kTriangle[0]}, 1.0), hash);

  SceneBuilder builder("another name");
  builder.set_surface({.color = {1, 0, 0}});
  builder.add_light({1, 2, 3});
  builder.add_polygon(kTriangle);
  builder.add_sphere({0, 0, 0}, 1.0);
  EXPECT_EQ(scene_hash(std::move(builder).build()), hash);
}

TEST(SceneHash, DependsOnOrder) {
  SceneBuilder builder("test");
  builder.add_sphere({0, 0, 0}, 1.0);
  builder.add_polygon(kTriangle);
  EXPECT_NE(scene_hash(std::move(builder).build()), hash_of(kTriangle, 1.0));
}

}  // namespace
}  // namespace beambench::scenes

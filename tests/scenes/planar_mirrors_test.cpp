// The planes of a scene's mirrors.

#include "scenes/planar_mirrors.hpp"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes {
namespace {

using glm::dvec3;

Surface mirror() {
  Surface surface;
  surface.specular = 0.5F;
  return surface;
}

/// Adds a parallelogram with sides `u` and `v` from `corner`.
void add_square(SceneBuilder& builder, const dvec3& corner, const dvec3& u, const dvec3& v) {
  const dvec3 corners[] = {corner, corner + u, corner + u + v, corner + v};
  builder.add_polygon(corners);
}

TEST(PlanarMirrors, AreTheReflectingPolygonsByPlane) {
  SceneBuilder builder("mirrors");
  builder.set_surface(mirror());
  builder.add_sphere({0.0, 0.0, 5.0}, 1.0);
  add_square(builder, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
  add_square(builder, {0.0, 0.0, 2.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
  add_square(builder, {5.0, 0.0, 1.0}, {0.0, 1.0, 0.0}, {1.0, 0.0, 0.0});  // from below
  builder.set_surface({});
  add_square(builder, {-5.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
  const Scene scene = std::move(builder).build();
  const auto mirrors = planar_mirrors(scene);
  ASSERT_EQ(mirrors.size(), 2U);
  EXPECT_EQ(mirrors[0].polygons, (std::vector<PrimitiveId>{1, 3}));
  EXPECT_EQ(mirrors[1].polygons, (std::vector<PrimitiveId>{2}));
  EXPECT_EQ(std::abs(mirrors[0].normal.z), 1.0);
  EXPECT_EQ(mirrors[0].point.z, 1.0);
}

TEST(PlanarMirrors, ExcludeBentAndSmoothPolygons) {
  SceneBuilder builder("mirrors");
  builder.set_surface(mirror());
  const dvec3 bent[] = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.001}, {0.0, 1.0, 0.0}};
  builder.add_polygon(bent);
  EXPECT_TRUE(planar_mirrors(std::move(builder).build()).empty());
  SceneBuilder smooth("smooth");
  smooth.set_surface(mirror());
  const dvec3 corners[] = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}};
  const dvec3 normals[] = {{0.1, 0.0, 1.0}, {0.0, 0.0, 1.0}, {0.0, 0.1, 1.0}};
  smooth.add_polygon(corners, normals);
  EXPECT_TRUE(planar_mirrors(std::move(smooth).build()).empty());
  EXPECT_TRUE(planar_mirrors(load_scene("tetra:n=2")).empty());  // nothing reflects
  EXPECT_TRUE(planar_mirrors(load_scene("escena1")).empty());    // spheres
}

TEST(PlanarGlass, IsOfOneTransparentSurface) {
  SceneBuilder builder("glass");
  const auto square = [&](double x) {
    add_square(builder, {x, 0.0, 1.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
  };
  builder.set_surface({.transmittance = 0.8F, .refraction_index = 1.5F});
  square(0.0);
  square(2.0);
  builder.set_surface({.transmittance = 0.8F, .refraction_index = 1.3F});
  square(4.0);
  builder.set_surface(mirror());
  square(6.0);
  const auto glass = planar_glass(std::move(builder).build());
  ASSERT_EQ(glass.size(), 2U);
  EXPECT_EQ(glass[0].polygons, (std::vector<PrimitiveId>{0, 1}));
  EXPECT_EQ(glass[1].polygons, (std::vector<PrimitiveId>{2}));
}

// However a plane is tilted, rounding the corners of large polygons does not bend it.
TEST(PlanarMirrors, OfTiltedPlanesAreNotSplit) {
  for (int turn = 1; turn < 40; ++turn) {
    const double angle = 0.1 * turn;
    const dvec3 u(std::cos(angle), 0.3 * std::sin(angle), std::sin(angle));
    const dvec3 v = glm::cross(glm::normalize(u), dvec3(0.3, 0.9, 0.1));
    SceneBuilder builder("mirrors");
    builder.set_surface(mirror());
    for (int i = 0; i < 2; ++i) add_square(builder, 1.5 * i * u - 0.7 * i * v, u, v);
    const auto mirrors = planar_mirrors(std::move(builder).build());
    std::size_t polygons = 0;
    for (const PlanarSurface& each : mirrors) polygons += each.polygons.size();
    EXPECT_EQ(polygons, 2U) << turn;
    EXPECT_LE(mirrors.size(), 2U) << turn;  // two if the plane lies between two cells of planes
  }
}

}  // namespace
}  // namespace beambench::scenes

// The surfaces proven to hide their backs, and the viewpoints from which they do.

#include "accel/tile_beam/solids.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "accel/exhaustive/exhaustive.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/closed_bodies.hpp"

namespace beambench::accel::tile_beam {
namespace {

using glm::dvec3;
using scenes::modelling::PolygonMesh;
using tests::Body;

scenes::Scene scene_of(const std::vector<PolygonMesh>& meshes) {
  scenes::SceneBuilder builder("meshes");
  for (const PolygonMesh& mesh : meshes) scenes::modelling::add_flat(builder, mesh);
  return std::move(builder).build();
}

PolygonMesh moved(PolygonMesh mesh, const dvec3& shift, const dvec3& scale = dvec3(1.0)) {
  for (dvec3& vertex : mesh.vertices) vertex = shift + scale * vertex;
  return mesh;
}

/// Returns the number of triangles of each solid in some meshes.
std::vector<std::uint32_t> sizes(const std::vector<PolygonMesh>& meshes) {
  std::vector<std::uint32_t> counts;
  for (const Solid& solid : find_solids(scene_of(meshes)).solids) {
    counts.push_back(solid.triangle_count);
  }
  return counts;
}

using Sizes = std::vector<std::uint32_t>;

TEST(Solids, AreStarShapedBodies) {
  for (const Body& body : tests::bodies()) {
    const Sizes expected = body.name == "torus"
                               ? Sizes{}
                               : Sizes{static_cast<std::uint32_t>(body.mesh.polygons.size())};
    EXPECT_EQ(sizes({body.mesh}), expected) << body.name;
  }
}

TEST(Solids, ListTheirTriangles) {
  const PolygonMesh body = tests::tetrahedron();
  const scenes::Scene scene =
      scene_of({body, moved(body, dvec3(5.0)), moved(body, dvec3(-5.0), dvec3(-1.0))});
  const Solids found = find_solids(scene);
  ASSERT_EQ(found.solids.size(), 3U);
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found.solids[i].inward, i == 2);  // mirrored, the corners have the opposite winding
    for (const std::uint32_t triangle : found.triangles_of(found.solids[i])) {
      EXPECT_EQ(triangle / 4, i);
      EXPECT_EQ(found.of_triangle[triangle], i);
    }
  }
}

TEST(Solids, AreNeitherOpenNorTwistedNorFlat) {
  const PolygonMesh whole = tests::tetrahedron();
  PolygonMesh open = whole;
  open.polygons.pop_back();
  EXPECT_EQ(sizes({open}), Sizes{});
  PolygonMesh twisted = whole;
  std::ranges::reverse(twisted.polygons[2]);
  EXPECT_EQ(sizes({twisted}), Sizes{});
  PolygonMesh flat = whole;  // folded paper: the same triangle from both sides
  flat.polygons = {{0, 1, 2}, {2, 1, 0}};
  EXPECT_EQ(sizes({flat}), Sizes{});
  // The first body is a solid, whatever is next to it.
  EXPECT_EQ(sizes({open, moved(whole, dvec3(4.0)), moved(twisted, dvec3(8.0))}), Sizes{4});
}

TEST(Solids, AreNotSurfacesThatCrossThemselves) {
  // A ball with a vertex pulled through its center and out on the other side, where the backs of
  // the triangles around it are visible.
  const PolygonMesh ball =
      scenes::modelling::triangulated(scenes::modelling::ellipsoid(dvec3(1.0), 16, 10));
  ASSERT_EQ(sizes({ball}).size(), 1U);
  for (std::size_t i = 0; i < ball.vertices.size(); ++i) {
    const dvec3 at = ball.vertices[i];
    PolygonMesh pulled = ball;
    pulled.vertices[i] = -1.5 * at;
    EXPECT_EQ(sizes({pulled}), Sizes{}) << "vertex " << i;
    // The vertex is pulled past its neighbors, so triangles are folded over.
    pulled.vertices[i] = at + dvec3(-at.y, at.z, at.x);
    EXPECT_EQ(sizes({pulled}), Sizes{}) << "vertex " << i;
  }
  // Twice around the axis: all volumes are positive, but a ray from the center meets two triangles.
  PolygonMesh star;
  for (int i = 0; i < 5; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 5.0;
    star.vertices.emplace_back(std::cos(angle), std::sin(angle), 0.0);
  }
  star.vertices.emplace_back(0.0, 0.0, 1.0);
  star.vertices.emplace_back(0.0, 0.0, -1.0);
  for (std::uint32_t i = 0; i < 5; ++i) {
    const std::uint32_t next = (i + 2) % 5;
    star.polygons.push_back({i, next, 5});
    star.polygons.push_back({next, i, 6});
  }
  EXPECT_EQ(sizes({star}), Sizes{});
}

TEST(Solids, AreSeparateIfTheyTouchAtCorners) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=3");
  const Solids found = find_solids(scene);
  EXPECT_EQ(found.solids.size(), 16U);
  for (const Solid& solid : found.solids) EXPECT_EQ(solid.triangle_count, 4U);
}

TEST(Solids, MayHaveAFinOnAnEdge) {
  PolygonMesh mesh = tests::tetrahedron();
  mesh.vertices.emplace_back(3.0, 3.0, 3.0);
  mesh.polygons.push_back({0, 1, 4});
  EXPECT_LE(sizes({mesh}).size(), 1U);  // the fin itself is not a solid
  for (const std::uint32_t size : sizes({mesh})) EXPECT_EQ(size, 4U);
}

TEST(Solids, IgnoreTheSignOfZero) {
  PolygonMesh mesh = moved(tests::tetrahedron(), dvec3(1.0));
  const auto origin = std::ranges::find(mesh.vertices, dvec3(2.0, 0.0, 0.0));
  ASSERT_NE(origin, mesh.vertices.end());
  // One triangle uses a second vertex at the same position, with zeros of the opposite sign.
  mesh.vertices.emplace_back(2.0, -0.0, -0.0);
  auto& corners = mesh.polygons.front();
  std::ranges::replace(corners, static_cast<std::uint32_t>(origin - mesh.vertices.begin()),
                       static_cast<std::uint32_t>(mesh.vertices.size() - 1));
  EXPECT_EQ(sizes({mesh}), Sizes{4});
}

TEST(Solids, DoNotExistInAnEmptyScene) {
  EXPECT_TRUE(find_solids(scenes::SceneBuilder("empty").build()).solids.empty());
  EXPECT_TRUE(find_solids(scenes::load_scene("balls:n=1")).solids.empty());
}

/// Checks a star-shaped body: an eye is inside if the surface lies behind it, seen from the center.
TEST(Solids, KnowEyesOutside) {
  Random random(3);
  for (const Body& body : tests::bodies()) {
    for (int i = 0; i < 40; ++i) {
      const tests::Placement place(random);
      PolygonMesh mesh = body.mesh;
      for (dvec3& vertex : mesh.vertices) vertex = place(vertex);
      if (i % 2 == 0) {
        for (auto& corners : mesh.polygons) std::ranges::reverse(corners);
      }
      const scenes::Scene scene = scene_of({mesh});
      const Solids found = find_solids(scene);
      if (found.solids.empty()) continue;  // the torus
      const Solid& solid = found.solids.front();
      const exhaustive::Exhaustive exhaustive(scene);
      const double size = glm::length(dvec3(scene.bounds.extent()));
      for (int eye = 0; eye < 50; ++eye) {
        Ray out;
        const dvec3 from =
            solid.center + size * random.uniform(0.0, 0.8) * tests::direction_from(random);
        out.origin = glm::vec3(from);
        out.direction = glm::vec3(from - solid.center);
        const auto hit = exhaustive.closest_hit(out, nullptr);
        const bool outside = is_outside(scene, found, solid, out.origin, 1'000'000);
        EXPECT_FALSE(outside && hit.has_value()) << body.name;
        // Not clearly outside: near the surface.
        if (!outside && !hit) {
          const auto from_center = exhaustive.closest_hit(
              {glm::vec3(solid.center), 0.0F, out.direction, kInfinity}, nullptr);
          ASSERT_TRUE(from_center.has_value()) << body.name;
          EXPECT_GT(from_center->t, 0.99F) << body.name;
        }
        // Outside the box, without examining triangles.
        EXPECT_TRUE(outside || !is_outside(scene, found, solid, out.origin, 0));
      }
    }
  }
}

TEST(Solids, DoNotCountEyesOnTheirSurfaceAsOutside) {
  const scenes::Scene scene = scenes::load_scene("bumpy:triangles=768");
  const Solids found = find_solids(scene);
  ASSERT_EQ(found.solids.size(), 1U);
  const auto is_out = [&](const glm::vec3& eye) {
    return is_outside(scene, found, found.solids.front(), eye, 1000);
  };
  for (const glm::vec3& vertex : scene.vertices) {
    EXPECT_FALSE(is_out(vertex));
    EXPECT_FALSE(is_out(vertex * 0.999F));
    EXPECT_FALSE(is_out(vertex * 1.0000005F));  // by rounding
    EXPECT_TRUE(is_out(vertex * 1.01F));
  }
}

}  // namespace
}  // namespace beambench::accel::tile_beam

// The modelling functions: closed pieces face outward, and subdivision reaches its count.

#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/box.hpp"
#include "scenes/modelling/extrusion.hpp"
#include "scenes/modelling/lathe.hpp"
#include "scenes/modelling/letters.hpp"
#include "scenes/modelling/parametric_surface.hpp"
#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/modelling/subdivide.hpp"
#include "scenes/modelling/sweep.hpp"

namespace beambench::scenes {
namespace {

/// Returns the volume enclosed by a closed mesh, positive if it faces outward.
double volume(const modelling::PolygonMesh& mesh) {
  double sum = 0.0;
  for (const auto& corners : mesh.polygons) {
    const glm::dvec3& a = mesh.vertices[corners[0]];
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      sum += glm::dot(a, glm::cross(mesh.vertices[corners[i]], mesh.vertices[corners[i + 1]]));
    }
  }
  return sum / 6.0;
}

double surface_area(const modelling::PolygonMesh& mesh) {
  double sum = 0.0;
  for (const auto& corners : mesh.polygons)
    sum += 0.5 * glm::length(modelling::area_normal(mesh, corners));
  return sum;
}

/// Returns whether every edge has one polygon on each side, with opposite directions.
bool is_closed(const modelling::PolygonMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& corners : mesh.polygons) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      ++edges[{corners[i], corners[(i + 1) % corners.size()]}];
    }
  }
  for (const auto& [edge, count] : edges) {
    if (count != 1 || !edges.contains({edge.second, edge.first})) return false;
  }
  return !edges.empty();
}

const std::vector<glm::dvec2> kVase = {{0.0, 0.0}, {0.5, 0.1}, {0.8, 0.6}, {0.3, 1.2}, {0.0, 1.3}};

TEST(Box, IsClosedAndSpansItsCorners) {
  const modelling::PolygonMesh mesh = modelling::box({-1, -2, -3}, {1, 2, 3});
  EXPECT_EQ(mesh.size(), 6U);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(volume(mesh), 48.0, 1e-12);
  EXPECT_EQ(modelling::box_without_bottom({0, 0, 0}, {1, 1, 1}).size(), 5U);
}

TEST(BeveledBox, IsClosedAndLosesItsEdges) {
  const modelling::PolygonMesh mesh = modelling::beveled_box({0, 0, 0}, {2, 2, 2}, 0.1);
  EXPECT_EQ(mesh.size(), 26U);
  EXPECT_TRUE(is_closed(mesh));
  // The bevels cut off 12 prisms with half a square as their base over the inner length, and at
  // each corner a cube without the tetrahedron that remains of it.
  const double edges = 12.0 * 0.5 * 0.01 * 1.8;
  const double corners = 8.0 * 0.001 * (5.0 / 6.0);
  EXPECT_NEAR(volume(mesh), 8.0 - edges - corners, 1e-12);
}

TEST(Lathe, ClosesAtItsPolesAndLooksOutward) {
  const modelling::PolygonMesh mesh = modelling::lathe(kVase, 12);
  EXPECT_EQ(mesh.size(), 12U * 4U);
  EXPECT_TRUE(is_closed(mesh));
  double expected = 0.0;  // frustums over regular 12-gons
  const double disc = 6.0 * std::sin(2.0 * std::numbers::pi / 12.0);
  for (std::size_t i = 0; i + 1 < kVase.size(); ++i) {
    const double a = kVase[i].x;
    const double b = kVase[i + 1].x;
    expected += disc * (kVase[i + 1].y - kVase[i].y) * (a * a + a * b + b * b) / 3.0;
  }
  EXPECT_NEAR(volume(mesh), expected, 1e-12);
}

TEST(Lathe, LeavesEndsWithARadiusOpen) {
  const std::vector<glm::dvec2> pipe = {{1.0, 0.0}, {1.0, 2.0}};
  EXPECT_EQ(modelling::lathe(pipe, 8).size(), 8U);
  EXPECT_FALSE(is_closed(modelling::lathe(pipe, 8)));
}

TEST(Tube, IsClosedByCapsAndTips) {
  const std::vector<glm::dvec3> knots = {{0, 0, 0}, {1, 0, 0.5}, {1.5, 1, 1}, {1, 2, 2}};
  const std::vector<glm::dvec3> path = modelling::spline(knots, 4);
  ASSERT_EQ(path.size(), 13U);
  std::vector<double> radii(path.size(), 0.2);
  const modelling::PolygonMesh capped = modelling::tube(path, radii, 6, modelling::Caps::kBoth);
  EXPECT_EQ(capped.size(), 6U * 12U + 2U);
  EXPECT_TRUE(is_closed(capped));
  EXPECT_GT(volume(capped), 0.0);
  radii.back() = 0.0;
  const modelling::PolygonMesh tip = modelling::tube(path, radii, 6, modelling::Caps::kStart);
  EXPECT_EQ(tip.size(), 6U * 12U + 1U);
  EXPECT_TRUE(is_closed(tip));
}

TEST(Sweep, KeepsItsOutlineAcrossThePath) {
  const std::vector<glm::dvec3> path = {{0, 0, 0}, {0, 0, 1}, {0, 0, 3}};
  const std::vector<double> scales = {1.0, 1.0, 1.0};
  const modelling::PolygonMesh mesh =
      modelling::sweep(modelling::circle(24), path, scales, {1, 0, 0}, modelling::Caps::kBoth);
  EXPECT_NEAR(volume(mesh), 3.0 * 12.0 * std::sin(2.0 * std::numbers::pi / 24.0), 1e-12);
}

TEST(Ellipsoid, ApproachesItsVolume) {
  const modelling::PolygonMesh mesh = modelling::ellipsoid({1, 2, 3}, 64, 32);
  EXPECT_EQ(mesh.size(), 64U * 32U);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(volume(mesh), 4.0 / 3.0 * std::numbers::pi * 6.0, 0.15);
}

TEST(ParametricSurface, IsWeldedWhereItMeetsItself) {
  const modelling::PolygonMesh torus = modelling::parametric_surface(
      [](double u, double v) {
        const double a = 2.0 * std::numbers::pi * u;
        const double b = 2.0 * std::numbers::pi * v;
        const double r = 2.0 + 0.5 * std::cos(b);
        return glm::dvec3(r * std::cos(a), r * std::sin(a), 0.5 * std::sin(b));
      },
      16, 8);
  EXPECT_EQ(torus.size(), 16U * 8U);
  EXPECT_EQ(torus.vertices.size(), 16U * 8U);
  EXPECT_TRUE(is_closed(torus));
  EXPECT_GT(volume(torus), 0.0);
}

TEST(Letters, AreClosedBodiesOfTheirOutlines) {
  for (const char name : std::string("ABEGILOT")) {
    const modelling::PolygonMesh body = modelling::extruded_text(std::string(1, name), 2.0, 0.5);
    EXPECT_TRUE(is_closed(body)) << name;
    const modelling::FlatShape shape = modelling::letter(name).shape;
    modelling::PolygonMesh flat;
    for (const glm::dvec2& point : shape.points) flat.vertices.emplace_back(point, 0.0);
    double area = 0.0;
    for (const auto& corners : shape.polygons) {
      const double part = modelling::area_normal(flat, corners).z / 2.0;
      EXPECT_GT(part, 0.0) << name;
      area += part;
    }
    EXPECT_NEAR(volume(body), area * 4.0 * 0.5, 1e-12) << name;
  }
  EXPECT_THROW(modelling::letter('?'), std::invalid_argument);
  EXPECT_NEAR(modelling::text_width("IL", 2.0), 2.0 * (0.22 + 0.14 + 0.56), 1e-12);
}

TEST(Transformed, ReversesWindingsIfItMirrors) {
  const modelling::PolygonMesh mesh = modelling::box({0, 0, 0}, {1, 1, 1});
  const glm::dmat4 mirror = glm::scale(glm::dmat4(1.0), glm::dvec3(-2.0, 1.0, 1.0));
  EXPECT_NEAR(volume(modelling::transformed(mesh, mirror)), 2.0, 1e-12);
  EXPECT_NEAR(volume(modelling::turned_inside_out(mesh)), -1.0, 1e-12);
}

TEST(Rotation, TurnsCounterClockwiseAboutEachAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec4 next(0.0);
    next[(axis + 1) % 3] = 1.0;
    const glm::dvec4 turned = modelling::rotation(axis, 90.0) * next;
    EXPECT_NEAR(turned[(axis + 2) % 3], 1.0, 1e-15);
    EXPECT_NEAR(turned[(axis + 1) % 3], 0.0, 1e-15);
  }
}

TEST(AddSmooth, PaintsEachPolygon) {
  SceneBuilder builder("two colors");
  modelling::add_smooth(builder, modelling::box({0, 0, 0}, {1, 1, 1}),
                        {.paint = [](std::size_t polygon) {
                          return Surface{.color = glm::vec3(polygon < 3 ? 0.25F : 0.75F)};
                        }});
  const Scene scene = std::move(builder).build();
  for (std::size_t id = 0; id < 6; ++id) {
    EXPECT_EQ(scene.surfaces[scene.primitives[id].surface].color.x, id < 3 ? 0.25F : 0.75F);
  }
}

TEST(Welded, DropsDegeneratePolygons) {
  modelling::PolygonMesh mesh = modelling::box({0, 0, 0}, {1, 1, 1});
  modelling::append(mesh, modelling::box({1, 0, 0}, {2, 1, 1}));
  EXPECT_EQ(modelling::welded(mesh).vertices.size(), 12U);
  EXPECT_EQ(modelling::welded(mesh).size(), 12U);
  EXPECT_EQ(
      modelling::welded(modelling::transformed(mesh, glm::scale(glm::dmat4(1.0), {1.0, 1.0, 0.0})))
          .size(),
      4U);
}

/// Returns a closed mesh of quads and triangles with `sides` faces around its axis.
modelling::PolygonMesh vase(int sides) { return modelling::lathe(kVase, sides); }

RC_GTEST_PROP(Subdivided, HasTheExactCountOnTheSameSurface, ()) {
  const modelling::PolygonMesh mesh = vase(*rc::gen::inRange(3, 12));
  const auto count = mesh.size() + *rc::gen::inRange<std::size_t>(0, 300);
  const modelling::PolygonMesh fine = modelling::subdivided_to(mesh, count);
  RC_ASSERT(fine.size() == count);
  RC_ASSERT(is_closed(fine));
  RC_ASSERT(std::abs(volume(fine) - volume(mesh)) < 1e-9);
  RC_ASSERT(std::abs(surface_area(fine) - surface_area(mesh)) < 1e-9);
  std::set<std::set<std::uint32_t>> distinct;
  for (const auto& corners : fine.polygons) {
    RC_ASSERT(glm::length(modelling::area_normal(fine, corners)) > 1e-9);
    RC_ASSERT(distinct.emplace(corners.begin(), corners.end()).second);
  }
}

TEST(Subdivided, AddsASinglePolygonEvenToAClosedMeshOfTriangles) {
  const modelling::PolygonMesh mesh = modelling::triangulated(vase(6));
  for (std::size_t more = 0; more < 20; ++more) {
    const modelling::PolygonMesh fine = modelling::subdivided_to(mesh, mesh.size() + more);
    EXPECT_EQ(fine.size(), mesh.size() + more);
    EXPECT_TRUE(is_closed(fine)) << more;
    std::size_t with_a_straight_corner = 0;
    for (const auto& corners : fine.polygons) with_a_straight_corner += corners.size() - 3;
    EXPECT_EQ(with_a_straight_corner, more % 2);
  }
}

TEST(Subdivided, RefusesFewerThanExist) {
  EXPECT_THROW(modelling::subdivided_to(modelling::box({0, 0, 0}, {1, 1, 1}), 5),
               std::invalid_argument);
  EXPECT_THROW(modelling::subdivided_to(modelling::PolygonMesh{}, 1), std::invalid_argument);
  // A negative difference becomes this value.
  EXPECT_THROW(modelling::subdivided_to(modelling::box({0, 0, 0}, {1, 1, 1}), std::size_t{0} - 1),
               std::invalid_argument);
}

TEST(Triangulated, KeepsTheSurfaceOfConcavePolygons) {
  const modelling::PolygonMesh body = modelling::extruded_text("GATO BILL", 1.0, 0.3);
  const modelling::PolygonMesh fine = modelling::triangulated(body);
  EXPECT_NEAR(volume(fine), volume(body), 1e-6);
  for (const auto& corners : fine.polygons) EXPECT_EQ(corners.size(), 3U);
}

TEST(AddSmooth, RoundsGentleEdgesAndKeepsSharpOnes) {
  SceneBuilder cube("cube");
  modelling::add_smooth(cube, modelling::box({0, 0, 0}, {1, 1, 1}));
  const Scene sharp = std::move(cube).build();
  EXPECT_EQ(sharp.polygons.size(), 6U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(sharp.normals[i].x, -1.0F, 1e-6F);

  SceneBuilder ball("ball");
  modelling::add_smooth(ball, modelling::ellipsoid({1, 1, 1}, 32, 16));
  const Scene round = std::move(ball).build();
  for (const Polygon& polygon : round.polygons) {
    for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
      const glm::vec3 place = round.vertices[round.corners[polygon.first_corner + i]];
      const glm::vec3 normal = round.normals[polygon.first_normal + i];
      EXPECT_GT(glm::dot(place, normal), 0.99F);
    }
  }
}

}  // namespace
}  // namespace beambench::scenes

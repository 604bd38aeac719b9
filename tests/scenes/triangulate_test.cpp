#include "scenes/triangulate.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "scenes/core/random.hpp"

namespace beambench::scenes {
namespace {

using Corners = std::vector<glm::vec3>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Twice the vector area (Newell).
glm::dvec3 vector_area(const Corners& corners) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    sum += glm::cross(glm::dvec3(corners[i]), glm::dvec3(corners[(i + 1) % corners.size()]));
  }
  return sum;
}

glm::dvec3 vector_area(const Corners& corners, const std::array<std::uint32_t, 3>& triangle) {
  const auto [a, b, c] = triangle;
  return vector_area({corners[a], corners[b], corners[c]});
}

/// A star-shaped polygon, concave as a rule, in a random plane at a random place; with `ratio` 1
/// the corners lie on a circle and the polygon is convex.
Corners star(Random& random, std::size_t count, double ratio) {
  const auto direction = [&] {
    return glm::normalize(
        glm::dvec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)} +
        glm::dvec3(0.0, 0.0, 1e-3));
  };
  const glm::dvec3 u = direction();
  const glm::dvec3 v = glm::normalize(glm::cross(u, glm::normalize(direction() + u * 0.01)));
  const glm::dvec3 center{random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9)};
  Corners corners;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2.0 * 3.14159265358979 *
                         (static_cast<double>(i) + random.uniform(0.0, 0.7)) /
                         static_cast<double>(count);
    const double radius = random.uniform(ratio, 1.0);
    corners.emplace_back(center + radius * (std::cos(angle) * u + std::sin(angle) * v));
  }
  return corners;
}

/// The triangles tile the polygon: n - 2 of them, each with the polygon's winding, areas that sum
/// to the polygon's (with equal windings, an overlap or an overhang would make the sum larger).
void expect_tiling(const Corners& corners) {
  const Triangles triangles = triangulate(corners);
  const glm::dvec3 whole = vector_area(corners);
  double sum = 0.0;
  for (const auto& triangle : triangles) {
    const glm::dvec3 part = vector_area(corners, triangle);
    RC_ASSERT(glm::dot(part, whole) > 0.0);
    sum += glm::length(part);
  }
  RC_ASSERT(triangles.size() == corners.size() - 2);
  RC_ASSERT(std::abs(sum - glm::length(whole)) < 1e-5);
}

RC_GTEST_PROP(Triangulate, TilesConvexPolygons, (std::uint64_t seed)) {
  Random random(seed);
  expect_tiling(star(random, 3 + random.below(30), 1.0));
}

RC_GTEST_PROP(Triangulate, TilesConcavePolygons, (std::uint64_t seed)) {
  Random random(seed);
  expect_tiling(star(random, 4 + random.below(60), 0.1));
}

RC_GTEST_PROP(Triangulate, ReversedPolygonsGiveTheSameArea, (std::uint64_t seed)) {
  Random random(seed);
  Corners corners = star(random, 4 + random.below(20), 0.2);
  std::reverse(corners.begin(), corners.end());
  expect_tiling(corners);
}

RC_GTEST_PROP(Triangulate, IsDeterministic, (std::uint64_t seed)) {
  Random random(seed);
  const Corners corners = star(random, 4 + random.below(20), 0.2);
  RC_ASSERT(triangulate(corners) == triangulate(Corners(corners)));
}

TEST(Triangulate, ConvexPolygonIsAFanAroundItsFirstCorner) {
  const Corners square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_EQ(triangulate(square), (Triangles{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Triangulate, ConcaveQuadIsCutAtItsReflexCorner) {
  const Corners arrow = {{0, 0, 0}, {2, -2, 0}, {0, 2, 0}, {-2, -2, 0}};  // reflex at corner 0
  for (const auto& triangle : triangulate(arrow)) {
    EXPECT_NE(std::find(triangle.begin(), triangle.end(), 0U), triangle.end());
    EXPECT_NE(std::find(triangle.begin(), triangle.end(), 2U), triangle.end());
  }
}

TEST(Triangulate, CornersOnAStraightEdgeAreKept) {
  // A neighbor may share such a corner; without it in a triangle there would be a crack.
  const Corners corners = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}};
  const Triangles triangles = triangulate(corners);
  EXPECT_EQ(triangles.size(), 4U);
  for (std::uint32_t corner = 0; corner < 6; ++corner) {
    EXPECT_TRUE(std::any_of(triangles.begin(), triangles.end(), [&](const auto& t) {
      return std::find(t.begin(), t.end(), corner) != t.end();
    })) << corner;
  }
}

TEST(Triangulate, HoleJoinedByABridgeIsTiled) {
  // A square with a square hole; the bridge runs from corner 0 to the hole's corner 4 and back.
  const Corners corners = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {0, 0, 0},
                           {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}};
  double sum = 0.0;
  for (const auto& triangle : triangulate(corners)) {
    EXPECT_GT(vector_area(corners, triangle).z, 0.0);
    sum += vector_area(corners, triangle).z;
  }
  EXPECT_DOUBLE_EQ(sum, 2.0 * (9.0 - 1.0));
}

TEST(Triangulate, NothingComesBackWithoutArea) {
  EXPECT_TRUE(triangulate(Corners{}).empty());
  EXPECT_TRUE(triangulate(Corners{{0, 0, 0}, {1, 1, 1}}).empty());
  EXPECT_TRUE(triangulate(Corners{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}}).empty());
  EXPECT_TRUE(triangulate(Corners{{2, 2, 2}, {2, 2, 2}, {2, 2, 2}, {2, 2, 2}}).empty());
}

TEST(Triangulate, PolygonThatCrossesItselfStillEnds) {
  const Corners bow = {{0, 0, 0}, {3, 3, 0}, {3, 0, 0}, {0, 2, 0}};
  EXPECT_LE(triangulate(bow).size(), 2U);
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    Corners corners;
    for (int k = 0; k < 12; ++k) {
      corners.emplace_back(random.below(4), random.below(4), random.below(2));
    }
    EXPECT_LE(triangulate(corners).size(), corners.size() - 2);
  }
}

TEST(Triangulate, TenThousandCornersAreQuick) {
  Random random(11);
  EXPECT_GT(triangulate(star(random, 10000, 0.5)).size(), 9900U);
}

}  // namespace
}  // namespace beambench::scenes

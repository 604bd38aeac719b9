#include "scenes/triangulate.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "scenes/base/random.hpp"
#include "scenes/corner_search.hpp"

namespace beambench::scenes {
namespace {

using Corners = std::vector<glm::vec3>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Returns twice the vector area (Newell).
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

/// Returns a star-shaped polygon, usually concave, in a random plane at a random place. If `ratio`
/// is 1, the corners lie on a circle and the polygon is convex.
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

/// Expects the triangles to tile the polygon: n - 2 triangles, each with the polygon's winding,
/// whose areas sum to the polygon's (with equal windings, any overlap or overhang would make the
/// sum larger).
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
  // A neighbor may share such a corner; if no triangle had it, there would be a crack.
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

TEST(Triangulate, PolygonsWithoutAreaYieldNoTriangles) {
  EXPECT_TRUE(triangulate(Corners{}).empty());
  EXPECT_TRUE(triangulate(Corners{{0, 0, 0}, {1, 1, 1}}).empty());
  EXPECT_TRUE(triangulate(Corners{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}}).empty());
  EXPECT_TRUE(triangulate(Corners{{2, 2, 2}, {2, 2, 2}, {2, 2, 2}, {2, 2, 2}}).empty());
}

TEST(Triangulate, SelfIntersectingPolygonTerminates) {
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

/// Clips ears of counter-clockwise polygons in the plane z = 0, but examines all corners at each
/// step: the program's search for the next corner must not change the result.
Triangles triangulate_by_looking_at_all(const Corners& corners) {
  struct Corner {
    std::uint32_t number;
    glm::dvec2 place;
    bool was_never_convex = true;
  };
  std::vector<Corner> ring;
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    ring.push_back({i, glm::dvec2(corners[i]) - glm::dvec2(corners[0])});
  }
  const auto place = [&](std::size_t i) { return ring[i % ring.size()].place; };
  const auto ear_area = [&](std::size_t i) {
    return signed_area(place(i + ring.size() - 1), place(i), place(i + 1));
  };
  const auto is_ear = [&](std::size_t i) {
    const glm::dvec2 a = place(i + ring.size() - 1);
    const glm::dvec2 b = place(i);
    const glm::dvec2 c = place(i + 1);
    return ear_area(i) > 0.0 && std::none_of(ring.begin(), ring.end(), [&](const Corner& corner) {
             const glm::dvec2 p = corner.place;
             return corner.was_never_convex && p != a && p != b && p != c &&
                    signed_area(a, b, p) >= 0.0 && signed_area(b, c, p) >= 0.0 &&
                    signed_area(c, a, p) >= 0.0;
           });
  };
  Triangles triangles;
  std::size_t start = 1;
  while (ring.size() >= 3) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (ear_area(i) > 0.0) ring[i].was_never_convex = false;
    }
    const auto first = [&](const auto& condition) -> std::optional<std::size_t> {
      for (std::size_t i = start; i < start + ring.size(); ++i) {
        if (condition(i % ring.size())) return i % ring.size();
      }
      return std::nullopt;
    };
    auto found = first(is_ear);
    if (!found) found = first([&](std::size_t i) { return ear_area(i) == 0.0; });
    if (!found) found = first([&](std::size_t i) { return ear_area(i) > 0.0; });
    if (!found) break;
    if (ear_area(*found) > 0.0) {
      triangles.push_back({ring[(*found + ring.size() - 1) % ring.size()].number,
                           ring[*found].number, ring[(*found + 1) % ring.size()].number});
    }
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(*found));
    start = *found;
  }
  return triangles;
}

TEST(Triangulate, TheSearchForEarsDoesNotChangeTheTriangles) {
  std::size_t compared = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const std::size_t count = 3 + random.below(seed % 10 == 0 ? 300 : 40);
    // Collinear edges and coincident corners are common only on a small lattice.
    const std::uint64_t lattice = std::array<std::uint64_t, 4>{4, 12, 100, 1U << 20U}[seed % 4];
    const bool crosses_itself = seed % 3 == 0;
    Corners corners;
    for (std::size_t i = 0; i < count; ++i) {
      const double radius = random.uniform(0.1, 1.0);
      const double angle =
          2.0 * 3.14159265358979 * static_cast<double>(i) / static_cast<double>(count);
      const double extent = static_cast<double>(lattice);
      const glm::dvec2 place =
          crosses_itself
              ? glm::dvec2{random.below(lattice), random.below(lattice)}
              : glm::round(extent * radius * glm::dvec2(std::cos(angle), std::sin(angle)));
      corners.emplace_back(place.x, place.y, 0.0);
    }
    if (vector_area(corners).z <= 0.0) continue;
    ++compared;
    ASSERT_EQ(triangulate(corners), triangulate_by_looking_at_all(corners));
  }
  EXPECT_GT(compared, 400U);
}

// Examining all corners took 28 s for such a star, and 60 s or more for 20,000 random corners. The
// limit is generous for the sanitizers.
TEST(Triangulate, AHundredThousandCornersAreQuick) {
  const auto begin = std::chrono::steady_clock::now();
  Random random(11);
  EXPECT_GT(triangulate(star(random, 100000, 0.5)).size(), 99000U);
  Corners anywhere;
  for (int i = 0; i < 100000; ++i) anywhere.emplace_back(random.unit(), random.unit(), 0.0);
  EXPECT_GT(triangulate(anywhere).size(), 10000U);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

}  // namespace
}  // namespace beambench::scenes

// Compares the thesis's test of whether a cube and a polygon overlap (section 3.3.2) with ours.
//
// It searches for a side of the polygon that meets the cube or else for a diagonal of the cube that
// meets the polygon. This is also exact: a plane that cuts a cube separates the ends of one of its
// diagonals, since all of them have the same midpoint; and if no side meets the cube, the plane's
// section of the cube lies entirely inside or outside the polygon. So an octree built by this test
// has the same references as ours, and no claim of the thesis depends on which test is used.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "accel/core/overlap.hpp"
#include "accel/core/tolerance.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::accel {
namespace {

using glm::dvec3;
using Corners = std::array<dvec3, 3>;

/// Returns whether a side meets the cube, by clipping it with the slabs of the three axes.
bool side_meets(const dvec3& a, const dvec3& b, const Box& cube) {
  double enter = 0.0;
  double exit = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double along = b[axis] - a[axis];
    if (along == 0.0) {
      if (a[axis] < cube.lower[axis] || a[axis] > cube.upper[axis]) return false;
      continue;
    }
    const double first = (cube.lower[axis] - a[axis]) / along;
    const double second = (cube.upper[axis] - a[axis]) / along;
    enter = std::max(enter, std::min(first, second));
    exit = std::min(exit, std::max(first, second));
  }
  return enter <= exit;
}

/// Returns whether a diagonal of the cube meets the triangle.
bool diagonal_meets(const Corners& corners, const Box& cube, int diagonal) {
  dvec3 from = cube.lower;
  dvec3 to = cube.upper;
  for (int axis = 0; axis < 2; ++axis) {
    if ((diagonal >> axis & 1) != 0) std::swap(from[axis], to[axis]);
  }
  const dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double before = glm::dot(normal, from - corners[0]);
  const double behind = glm::dot(normal, to - corners[0]);
  if (before * behind > 0.0 || before == behind) return false;
  const dvec3 point = from + before / (before - behind) * (to - from);
  for (std::size_t i = 0; i < 3; ++i) {
    const dvec3 side = corners[(i + 1) % 3] - corners[i];
    if (glm::dot(normal, glm::cross(side, point - corners[i])) < 0.0) return false;
  }
  return true;
}

bool thesis_overlaps(const Corners& corners, const Box& cube) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (side_meets(corners[i], corners[(i + 1) % 3], cube)) return true;
  }
  for (int diagonal = 0; diagonal < 4; ++diagonal) {
    if (diagonal_meets(corners, cube, diagonal)) return true;
  }
  return false;
}

Box widened(const Box& box, double by) { return {box.lower - by, box.upper + by}; }

/// Expects both tests to agree except within the tolerance of the boundary.
void expect_both_agree(const Corners& corners, const Box& cube, double tolerance) {
  const bool ours = triangle_overlaps(corners, cube, tolerance);
  if (thesis_overlaps(corners, cube)) {
    ASSERT_TRUE(ours);
  } else if (ours) {
    ASSERT_TRUE(thesis_overlaps(corners, widened(cube, 4.0 * tolerance)));
  }
}

TEST(ThesisOverlapOfTriangles, AgreesWithOursOnRandomTriangles) {
  Random random(1999);
  const auto point = [&](double size) {
    return dvec3{random.uniform(-size, size), random.uniform(-size, size),
                 random.uniform(-size, size)};
  };
  int overlaps = 0;
  for (int i = 0; i < 200'000; ++i) {
    const dvec3 middle = point(1.5);
    const double size = i % 2 == 0 ? 0.3 : 6.0;
    const Corners corners{middle + point(size), middle + point(size), middle + point(size)};
    const Box cube{dvec3(-1.0), dvec3(1.0)};
    expect_both_agree(corners, cube, 1e-12);
    overlaps += thesis_overlaps(corners, cube) ? 1 : 0;
  }
  EXPECT_GT(overlaps, 50'000);
  EXPECT_LT(overlaps, 150'000);
}

class ThesisOverlap : public testing::TestWithParam<const char*> {};

// Tests the cells of level 6, 32 along each axis, in the box of each triangle of the surface.
TEST_P(ThesisOverlap, AddsNoReferences) {
  const scenes::Scene scene = scenes::load_scene(GetParam());
  const double tolerance = overlap_tolerance(scene);
  const dvec3 lower(scene.bounds.lower);
  const dvec3 extent(scene.bounds.extent());
  const double size = std::max({extent.x, extent.y, extent.z}) / 32.0;
  std::uint64_t ours = 0;
  std::uint64_t the_thesiss = 0;
  for (const scenes::Triangle& triangle : scene.triangles) {
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = dvec3(scene.vertices[triangle.vertex[i]]);
    const dvec3 first =
        glm::floor((glm::min(glm::min(corners[0], corners[1]), corners[2]) - lower) / size);
    const dvec3 last =
        glm::floor((glm::max(glm::max(corners[0], corners[1]), corners[2]) - lower) / size);
    for (double x = first.x; x <= last.x; ++x) {
      for (double y = first.y; y <= last.y; ++y) {
        for (double z = first.z; z <= last.z; ++z) {
          const dvec3 corner = lower + size * dvec3(x, y, z);
          const Box cube{corner, corner + size};
          expect_both_agree(corners, cube, tolerance);
          ours += triangle_overlaps(corners, cube, tolerance) ? 1 : 0;
          the_thesiss += thesis_overlaps(corners, cube) ? 1 : 0;
        }
      }
    }
  }
  EXPECT_LE(the_thesiss, ours);
  EXPECT_LE(static_cast<double>(ours - the_thesiss), 1e-3 * static_cast<double>(ours));
}

INSTANTIATE_TEST_SUITE_P(Thesis, ThesisOverlap,
                         testing::Values("maceta", "delfines", "bola-espacial", "tetera", "misil",
                                         "casa-de-campo", "stetra", "habitacion"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace beambench::accel

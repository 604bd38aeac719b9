// Overlays: lines are in the right place, boxes hide objects behind them, and legends show counts.

#include "harness/render/picture/overlay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "accel/core/registry.hpp"
#include "harness/render/picture/raster.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::render {
namespace {

const glm::vec3 kGround(0.2F);

/// Returns an eye at the origin that looks along +x with y to the left and z up. A point (x, y, z)
/// appears at 50 - 50 y / x, 50 - 50 z / x.
accel::PrimaryRays view_along_x() {
  scenes::Camera camera;
  camera.at = {1.0F, 0.0F, 0.0F};
  camera.up = {0.0F, 0.0F, 1.0F};
  camera.angle = 90.0F;
  return {camera, 100, 100, 1};
}

bool is_ground(const Image& image, int x, int y) {
  return glm::distance(image.at(x, y), dimmed(kGround)) < 1e-6F;
}
/// Returns the share of a color mixed with the dimmed background.
float share_of(const glm::vec3& color, const Image& image, int x, int y) {
  const glm::vec3 ground = dimmed(kGround);
  return (image.at(x, y).x - ground.x) / (color.x - ground.x);
}
/// Returns the sum of a line's shares across a horizontal row of pixels, which is the thickness of
/// a vertical line.
float yellow_across(const Image& image, int y, int first, int last) {
  float sum = 0.0F;
  for (int x = first; x <= last; ++x) sum += share_of(okabe_ito::kYellow, image, x, y);
  return sum;
}

Image picture_of(const std::vector<accel::Box>& cells) {
  Image image(100, 100, kGround);
  overlay_cells(image, view_along_x(), cells);
  return image;
}

TEST(Line, CoversPixelsByTheirDistance) {
  std::vector<float> coverage(10 * 10, 0.0F);
  for_each_pixel({{2.0, 4.5}, {8.0, 4.5}}, 1.0, 10, 10, [&](int x, int y, float share, double) {
    coverage[static_cast<std::size_t>(10 * y + x)] = share;
  });
  for (int x = 2; x < 8; ++x) {
    EXPECT_EQ(coverage[static_cast<std::size_t>(40 + x)], 1.0F) << x;
    EXPECT_EQ(coverage[static_cast<std::size_t>(30 + x)], 0.0F) << x;
    EXPECT_EQ(coverage[static_cast<std::size_t>(50 + x)], 0.0F) << x;
  }
  EXPECT_EQ(coverage[40], 0.0F);
  EXPECT_EQ(coverage[49], 0.0F);
}

// By definition, a line visits the pixels whose centers are close enough to the segment.
RC_GTEST_PROP(Line, VisitsJustThePixelsNearIt, ()) {
  const auto coordinate = [] {
    return *rc::gen::element(1.0, 1.0, 1e4) * (*rc::gen::inRange(-300, 500) / 10.0);
  };
  const PixelSegment line{{coordinate(), coordinate()}, {coordinate(), coordinate()}};
  const double thickness = *rc::gen::inRange(5, 40) / 10.0;
  std::vector<int> visits(20 * 15, 0);
  for_each_pixel(line, thickness, 20, 15, [&](int x, int y, float coverage, double along) {
    ++visits[static_cast<std::size_t>(20 * y + x)];
    RC_ASSERT(coverage > 0.0F && coverage <= 1.0F);
    RC_ASSERT(along >= 0.0 && along <= 1.0);
  });
  const glm::dvec2 along = line.to - line.from;
  for (int y = 0; y < 15; ++y) {
    for (int x = 0; x < 20; ++x) {
      const glm::dvec2 center(x + 0.5, y + 0.5);
      const double square = glm::dot(along, along);
      const double s =
          square > 0.0 ? glm::clamp(glm::dot(center - line.from, along) / square, 0.0, 1.0) : 0.0;
      const double distance = glm::distance(center, line.from + s * along);
      const double beyond = distance - 0.5 * (thickness + 1.0);
      if (std::abs(beyond) < 1e-6) continue;  // rounding decides
      RC_ASSERT(visits[static_cast<std::size_t>(20 * y + x)] == (beyond < 0.0 ? 1 : 0));
    }
  }
}

TEST(ConvexFill, GivesEachPixelToOneOfTheTrianglesAroundAPoint) {
  const glm::dvec2 middle(10.5, 7.25);
  const std::vector<glm::dvec2> around{{-3, -2}, {12, -5},  {25, 3},
                                       {30, 18}, {8.5, 16}, {-4, 15.5}};
  std::vector<int> visits(20 * 15, 0);
  for (std::size_t i = 0; i < around.size(); ++i) {
    const std::vector<glm::dvec2> triangle{middle, around[i], around[(i + 1) % around.size()]};
    for_each_pixel_in(triangle, 20, 15,
                      [&](int x, int y) { ++visits[static_cast<std::size_t>(20 * y + x)]; });
  }
  for (const int each : visits) EXPECT_EQ(each, 1);
}

TEST(OverlayBeams, DrawsEachKindInItsColorAndCounts) {
  const std::vector<accel::BeamOutline> beams{
      {accel::BeamKind::kNonTerminal, {{5.5, 5.5}, {55.5, 5.5}, {55.5, 25.5}, {5.5, 25.5}}},
      {accel::BeamKind::kOccupied, {{5.5, 5.5}, {30.5, 5.5}, {30.5, 25.5}, {5.5, 25.5}}},
      {accel::BeamKind::kLeaving, {{60.5, 40.5}, {90.5, 40.5}, {90.5, 60.5}, {60.5, 60.5}}},
      {accel::BeamKind::kLeaving, {{30.5, 5.5}, {55.5, 5.5}, {55.5, 25.5}, {30.5, 25.5}}}};
  Image image(100, 80, kGround);
  const std::vector<LegendEntry> legend = overlay_beams(image, beams);

  ASSERT_EQ(legend.size(), 3U);
  EXPECT_EQ(legend[0].name, "occupied");
  EXPECT_EQ(legend[0].count, 1U);
  EXPECT_EQ(legend[1].name, "non-terminal");
  EXPECT_EQ(legend[1].count, 1U);
  EXPECT_EQ(legend[2].name, "leaving");
  EXPECT_EQ(legend[2].count, 2U);

  const auto near = [&](const glm::vec3& color, int x, int y) {
    return glm::distance(image.at(x, y), color) < 1e-5F;
  };
  EXPECT_TRUE(near(legend[0].color, 5, 15)) << "an occupied beam over its parent";
  EXPECT_TRUE(near(legend[0].color, 30, 15)) << "an occupied beam over one that leaves";
  EXPECT_TRUE(near(legend[1].color, 55, 15)) << "a beam that continues over one that leaves";
  EXPECT_TRUE(near(legend[2].color, 75, 40));
  EXPECT_TRUE(is_ground(image, 58, 30)) << "no beam covers this pixel";
  EXPECT_FALSE(is_ground(image, 15, 15)) << "ends are tinted";
  EXPECT_NE(image.at(15, 15), image.at(45, 15)) << "each in its color";
  EXPECT_EQ(image.at(45, 15), image.at(75, 50));
}

TEST(OverlayBeams, ATwofoldCoverIsDetected) {
  const accel::BeamOutline left{accel::BeamKind::kLeaving, {{0, 0}, {60, 0}, {60, 80}, {0, 80}}};
  const accel::BeamOutline right{accel::BeamKind::kLeaving,
                                 {{40, 0}, {100, 0}, {100, 80}, {40, 80}}};
  Image image(100, 80, kGround);
  overlay_beams(image, std::vector<accel::BeamOutline>{left, right});
  const float once = share_of(okabe_ito::kBluishGreen, image, 20, 40);
  const float twice = share_of(okabe_ito::kBluishGreen, image, 50, 40);
  EXPECT_GT(once, 0.05F);
  EXPECT_GT(twice, 1.5F * once);
}

TEST(OverlayBeams, TheEndsOfRealBeamsCoverNoPixelTwice) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=3");
  const accel::PrimaryRays rays(scene.cameras.front(), 200, 160, 1);
  const auto structure = accel::registry().choose(parse_spec("beam:max_level=4")).build(scene);
  const auto beams = structure->inspector()->beams(rays).value();
  std::vector<int> ends(200 * 160, 0);
  for (const accel::BeamOutline& beam : beams) {
    if (beam.kind == accel::BeamKind::kNonTerminal) continue;
    for_each_pixel_in(beam.corners, 200, 160,
                      [&](int x, int y) { ++ends[static_cast<std::size_t>(200 * y + x)]; });
  }
  EXPECT_EQ(std::count_if(ends.begin(), ends.end(), [](int n) { return n > 1; }), 0);
  EXPECT_GT(std::count(ends.begin(), ends.end(), 1), 10000);
}

// The front face of [2, 4] x [-1, 1] x [-1, 1] spans 25 ... 75 in both directions.
TEST(OverlayCells, AKnownBoxLandsOnKnownPixels) {
  const Image image = picture_of({{{2, -1, -1}, {4, 1, 1}}});
  for (const int y : {30, 45, 70}) {
    EXPECT_NEAR(yellow_across(image, y, 22, 27), 1.0F, 0.01F) << "left edge, row " << y;
    EXPECT_NEAR(yellow_across(image, y, 72, 77), 1.0F, 0.01F) << "right edge, row " << y;
    EXPECT_NEAR(yellow_across(image, y, 0, 21), 0.0F, 0.01F);
    EXPECT_NEAR(yellow_across(image, y, 28, 71), 0.0F, 0.01F) << "the back is hidden";
  }
  EXPECT_GT(share_of(okabe_ito::kYellow, image, 50, 24), 0.4F);
  EXPECT_GT(share_of(okabe_ito::kYellow, image, 50, 75), 0.4F);
  EXPECT_TRUE(is_ground(image, 50, 20));
}

TEST(OverlayCells, NearerCellsHideFartherOnes) {
  const accel::Box behind{{6, -0.75, -0.75}, {7, 0.75, 0.75}};
  const accel::Box beside{{6, -9, -0.75}, {7, -4.5, 0.75}};
  const accel::Box before{{2, -1, -1}, {3, 1, 1}};
  const Image alone = picture_of({before});
  for (const auto& cells :
       {std::vector<accel::Box>{before, behind}, std::vector<accel::Box>{behind, before}}) {
    const Image both = picture_of(cells);
    for (int y = 0; y < 100; ++y) {
      for (int x = 0; x < 100; ++x) EXPECT_EQ(both.at(x, y), alone.at(x, y)) << x << ' ' << y;
    }
  }
  const Image apart = picture_of({before, beside});
  EXPECT_GT(yellow_across(apart, 50, 85, 99), 0.3F) << "the cell beside it is visible";
  EXPECT_LT(yellow_across(apart, 50, 85, 99), 0.9F) << "but paler, because it is farther";
}

// Adjacent cells: the edges between them belong to both, and neither hides them.
TEST(OverlayCells, TouchingCellsDoNotHideTheirCommonEdges) {
  const Image image = picture_of({{{2, -1, -1}, {4, 0, 1}}, {{2, 0, -1}, {4, 1, 1}}});
  for (int y = 27; y < 73; ++y) EXPECT_NEAR(yellow_across(image, y, 46, 53), 1.0F, 0.01F) << y;
}

TEST(OverlayCells, ACellAroundTheEyeShowsItsEdgesAndHidesNothing) {
  const accel::Box around{{-2, -4, -4}, {8, 4, 4}};
  const accel::Box before{{2, -1, -1}, {4, 1, 1}};
  const Image image = picture_of({around, before});
  EXPECT_NEAR(yellow_across(image, 50, 22, 27), 1.0F, 0.01F);
  // The far face of the cell around the eye also spans 25 ... 75 and lies behind the other cell.
  // The edges toward the eye run from this face into the corners of the image.
  EXPECT_GT(share_of(okabe_ito::kYellow, image, 10, 10), 0.9F);
  EXPECT_GT(share_of(okabe_ito::kYellow, image, 90, 9), 0.9F);
  EXPECT_TRUE(is_ground(image, 10, 50));
}

// A beam through a box, from behind the eye to in front of it, passing on the lower left: parts
// behind the camera plane must not be mirrored into the image.
TEST(OverlayCells, EdgesAreCutOffAtTheEye) {
  const Image image = picture_of({{{-5, 1, -2}, {4, 2, -1}}});
  for (int y = 0; y < 50; ++y) {
    for (int x = 0; x < 100; ++x) EXPECT_TRUE(is_ground(image, x, y)) << x << ' ' << y;
  }
  for (int y = 0; y < 100; ++y) {
    for (int x = 50; x < 100; ++x) EXPECT_TRUE(is_ground(image, x, y)) << x << ' ' << y;
  }
  // The edge y = 1, z = -1 runs from (37.5, 62.5) into the corner on the lower left.
  EXPECT_GT(share_of(okabe_ito::kYellow, image, 20, 79), 0.5F);
  EXPECT_GT(share_of(okabe_ito::kYellow, image, 3, 96), 0.5F);
  const Image behind = picture_of({{{-5, -1, -1}, {-2, 1, 1}}});
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(is_ground(behind, i, 25));
}

TEST(OverlayCells, CountsAllCells) {
  Image image(100, 100, kGround);
  const std::vector<accel::Box> cells{{{2, -1, -1}, {4, 1, 1}}, {{-5, -1, -1}, {-2, 1, 1}}};
  const std::vector<LegendEntry> legend = overlay_cells(image, view_along_x(), cells);
  ASSERT_EQ(legend.size(), 1U);
  EXPECT_EQ(legend[0].count, 2U);
}

// For any eye, even close to faces and edges of cells, nothing is drawn where there is no cell.
TEST(OverlayCells, OnlyPixelsNextToCellsAreDrawnWhereRaysMiss) {
  const scenes::Scene scene = scenes::load_scene("balls:n=1");
  const auto structure = accel::registry().choose(parse_spec("samet:max_level=4")).build(scene);
  std::vector<accel::Box> cells;
  for (const accel::Cell& cell : structure->inspector()->occupied_cells()) {
    cells.push_back(cell.box);
  }
  ASSERT_FALSE(cells.empty());
  const accel::PrimaryRays rays(scene.cameras.front(), 120, 100, 1);
  Image image(120, 100, kGround);
  overlay_cells(image, rays, cells);
  const auto hits_a_cell = [&](double px, double py) {
    const accel::Ray ray = rays.ray_at(px, py);
    for (const accel::Box& cell : cells) {
      double first = 0.0;
      double last = std::numeric_limits<double>::infinity();
      for (int axis = 0; axis < 3; ++axis) {
        const double a = (cell.lower[axis] - ray.origin[axis]) / ray.direction[axis];
        const double b = (cell.upper[axis] - ray.origin[axis]) / ray.direction[axis];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
      }
      if (first <= last) return true;
    }
    return false;
  };
  int drawn = 0;
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 120; ++x) {
      if (is_ground(image, x, y)) continue;
      ++drawn;
      bool near = false;
      for (int i = 0; i < 25 && !near; ++i) {
        near = hits_a_cell(x + 0.5 * (i % 5 - 1) + 0.001, y + 0.5 * (i / 5 - 1) + 0.001);
      }
      EXPECT_TRUE(near) << x << ' ' << y;
    }
  }
  EXPECT_GT(drawn, 200);
}

TEST(LazyGrid, ShowsTheCellsThatRaysFilled) {
  const scenes::Scene scene = scenes::load_scene("balls:n=1");
  const accel::PrimaryRays rays(scene.cameras.front(), 16, 16, 1);
  accel::HitBuffer hits(16, 16, 1);
  const auto eager = accel::registry().choose(parse_spec("voxel-grid:fill=eager")).build(scene);
  const auto lazy = accel::registry().choose(parse_spec("voxel-grid:fill=lazy")).build(scene);
  EXPECT_FALSE(eager->inspector()->occupied_cells().empty());
  EXPECT_TRUE(lazy->inspector()->occupied_cells().empty());
  lazy->closest_hits(rays, hits, {});
  EXPECT_FALSE(lazy->inspector()->occupied_cells().empty());
  EXPECT_LE(lazy->inspector()->occupied_cells().size(),
            eager->inspector()->occupied_cells().size());
}

}  // namespace
}  // namespace beambench::render

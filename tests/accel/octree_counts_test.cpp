// The counts of tables 5.2 and 5.3 for our stand-ins for the thesis's lost scenes. They are
// reported next to the thesis's counts (results/published/thesis/stand-ins.md), but not fitted to
// them.

#include <array>
#include <cstdint>
#include <string_view>

#include <gtest/gtest.h>

#include "accel/core/primary_rays.hpp"
#include "accel/octree/leaf_walk.hpp"
#include "accel/octree/samet.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::accel {
namespace {

/// A row of the tables.
struct OctreeRow {
  const char* scene;
  int max_level;
  std::uint32_t max_objects;
  std::int64_t leaves, pixels;
};

void PrintTo(const OctreeRow& row, std::ostream* stream) {
  *stream << row.scene << " level " << row.max_level << " objects " << row.max_objects;
}

constexpr std::array<OctreeRow, 14> kRows = {{
    {"maceta", 6, 0, 2174, 544433},
    {"maceta", 6, 10, 886, 87384},
    {"maceta", 6, 20, 472, 77833},
    {"maceta", 6, 40, 241, 73372},
    {"maceta", 4, 0, 162, 136540},
    {"maceta", 5, 0, 587, 353247},
    {"maceta", 7, 0, 8094, 673003},
    {"delfines", 6, 0, 402, 1059452},
    {"delfines", 6, 10, 386, 930823},
    {"delfines", 6, 20, 364, 606973},
    {"delfines", 6, 40, 215, 535325},
    {"delfines", 4, 0, 38, 753105},
    {"delfines", 5, 0, 104, 978499},
    {"delfines", 7, 0, 1532, 1110432},
}};

const scenes::Scene& scene_of_row(const OctreeRow& row) {
  static const scenes::Scene maceta = scenes::load_scene("maceta");
  static const scenes::Scene delfines = scenes::load_scene("delfines");
  return row.scene == std::string_view("maceta") ? maceta : delfines;
}

octree::Octree octree_of(const OctreeRow& row) {
  octree::OctreeOptions options;
  options.max_level = row.max_level;
  options.max_objects = row.max_objects;
  return octree::Octree(scene_of_row(row), options);
}

/// Returns the number of pixels in beams that leave the root without meeting an occupied leaf: the
/// ray of such a pixel crosses only empty leaves of the root cube.
std::int64_t exit_pixels(const octree::Octree& octree, const scenes::Camera& camera) {
  const PrimaryRays rays(camera, 1280, 1024, 1);
  const octree::AncestorNeighbors neighbors(octree);
  NoCounting counting;
  std::int64_t pixels = 0;
  for (int y = 0; y < rays.height(); ++y) {
    for (int x = 0; x < rays.width(); ++x) {
      bool crosses = false;
      bool occupied = false;
      octree::walk_leaves(octree, neighbors, rays.ray(x, y, 0), counting,
                          [&](const octree::OctreeNode& leaf, double) {
                            crosses = true;
                            occupied = leaf.count > 0;
                            return occupied;
                          });
      if (crosses && !occupied) ++pixels;
    }
  }
  return pixels;
}

class OctreeCounts : public ::testing::TestWithParam<OctreeRow> {};

TEST_P(OctreeCounts, AreThoseReported) {
  const OctreeRow& row = GetParam();
  const octree::Octree octree = octree_of(row);
  const Statistics statistics = octree.statistics();
  EXPECT_EQ(static_cast<std::int64_t>(statistics.leaves - statistics.empty_leaves), row.leaves);
  EXPECT_EQ(exit_pixels(octree, scene_of_row(row).cameras[0]), row.pixels);
}

INSTANTIATE_TEST_SUITE_P(Thesis, OctreeCounts, ::testing::ValuesIn(kRows), [](const auto& info) {
  return std::string(info.param.scene) + "Level" + std::to_string(info.param.max_level) +
         "Objects" + std::to_string(info.param.max_objects);
});

}  // namespace
}  // namespace beambench::accel

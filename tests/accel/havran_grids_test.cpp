// Compares ours with Havran's and Sixta's published counts of grids ("Comparison of hierarchical
// grids", Ray Tracing News 12(1), 1999): primitives by their bounding boxes, a grid over the
// scene's own box.
//
// Results of the comparison:
// - Uniform grids: empty voxels agree within 2.4% and references within 6.2%, most within 1%; where
//   both are exact, the boxes are the same. His scene boxes are slightly larger than the scenes,
//   which matters at resolutions whose planes touch primitives. (gears is unexplained: he has 60%
//   more references at 32x33x9, and more interior nodes of octrees.)
// - Recursive grids: with the cube root of the number of primitives for the top grid (Woo 1992),
//   and voxels with more than 6 references divided, the numbers of grids on two levels agree within
//   1% for tetra and teapot, 2% for lattice and 5% for balls (equal numbers of voxels along the
//   axes), and exactly for balls with cubic voxels. With the same rule (one voxel per reference),
//   cubic inner grids match his numbers of voxels and empty voxels within 5%.
// - His rounding of the root for voxels with few references is not published: 37,984 voxels in
//   tetra's 1,056 inner grids are 256 grids of 4^3 and 800 of 3^3. Most of the divided voxels have
//   eight references, for which round(cbrt(n)) gives grids of only 2^3, so his inner grids have
//   more voxels and more references. At depth 3 the difference multiplies, and the counts do not
//   agree.

#include <array>
#include <cmath>
#include <cstdint>
#include <ostream>

#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "accel/core/statistics.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::accel {
namespace {

struct GridCounts {
  std::uint64_t voxels, empty, references;

  friend bool operator==(const GridCounts&, const GridCounts&) = default;
};

void PrintTo(const GridCounts& counts, std::ostream* out) {
  *out << counts.voxels << " voxels, " << counts.empty << " empty, " << counts.references
       << " references";
}

struct UniformRow {
  const char* scene;
  const char* resolution;
  GridCounts published, ours;
  double within;  ///< the largest difference, as a share of the published count
};

void expect_within(std::uint64_t published, std::uint64_t ours, double share) {
  const auto a = static_cast<double>(published);
  EXPECT_LE(std::abs(static_cast<double>(ours) - a), share * a) << published << " and " << ours;
}

Statistics sizes_of(const std::string& spec, const scenes::Scene& scene) {
  return registry().choose(parse_spec(spec)).build(scene)->statistics();
}

constexpr std::array<UniformRow, 17> kUniform = {{
    {"tetra:n=6", "16", {4096, 3104, 12556}, {4096, 3032, 13312}, 0.062},
    {"tetra:n=6", "35", {42875, 37311, 35936}, {42875, 37311, 35936}, 0.0},
    {"tetra:n=6", "40", {64000, 56696, 44696}, {64000, 56348, 46592}, 0.05},
    {"lattice", "20", {8000, 0, 32152}, {8000, 0, 32152}, 0.0},
    {"lattice", "44", {85184, 38016, 90368}, {85184, 38016, 87968}, 0.05},
    {"lattice", "59", {205379, 102640, 160819}, {205379, 104704, 153595}, 0.05},
    {"balls", "46x46x3", {6348, 4208, 10240}, {6348, 4208, 10257}, 0.002},
    {"balls", "103x103x7", {74263, 63393, 19966}, {74263, 63395, 20056}, 0.005},
    {"mount", "20", {8000, 6502, 21746}, {8000, 6520, 21341}, 0.05},
    {"mount", "35", {42875, 37246, 38922}, {42875, 37344, 37891}, 0.05},
    {"rings", "21x20x21", {8820, 6264, 27666}, {8820, 6264, 27553}, 0.005},
    {"rings", "44x43x44", {83248, 66753, 71303}, {83248, 67451, 68695}, 0.05},
    {"teapot", "28x29x11", {8932, 7226, 22982}, {8932, 7231, 23043}, 0.005},
    {"teapot", "61x61x25", {93025, 83721, 52781}, {93025, 83870, 49551}, 0.062},
    {"tree", "52x52x3", {8112, 5400, 11102}, {8112, 5400, 11107}, 0.001},
    {"tree", "60", {216000, 212179, 14322}, {216000, 212179, 13970}, 0.05},
    // Unexplained.
    {"gears", "32x33x9", {9504, 6080, 39344}, {9504, 6544, 24456}, 0.4},
}};

TEST(HavranGrids, UniformGridsHaveThePublishedSizes) {
  for (const UniformRow& row : kUniform) {
    SCOPED_TRACE(std::string(row.scene) + ' ' + row.resolution);
    const Statistics sizes =
        sizes_of(std::string("voxel-grid:assign=bbox,resolution=") + row.resolution,
                 scenes::load_scene(row.scene));
    EXPECT_EQ((GridCounts{sizes.leaves, sizes.empty_leaves, sizes.references}), row.ours);
    EXPECT_EQ(sizes.leaves, row.published.voxels);
    expect_within(row.published.empty, sizes.empty_leaves, row.within);
    expect_within(row.published.references, sizes.references, row.within);
  }
}

/// Recursive grids of two levels.
struct RecursiveRow {
  const char* scene;
  const char* shape;
  double published, ours;  ///< interior cells: grids
};

constexpr std::array<RecursiveRow, 5> kRecursive = {{
    {"tetra:n=6", "equal", 1057, 1065},
    {"lattice", "equal", 513, 521},
    {"balls", "equal", 69, 66},
    {"balls", "cubic", 49, 49},
    {"teapot", "equal", 874, 867},
}};

std::string recursive_grid(const std::string& shape) {
  return "hierarchical-grid:divide=always,assign=bbox,max_level=2,density=1,inner_density=1,"
         "max_objects=6,shape=" +
         shape;
}

TEST(HavranGrids, RecursiveGridsHaveThePublishedNumberOfGrids) {
  for (const RecursiveRow& row : kRecursive) {
    SCOPED_TRACE(std::string(row.scene) + ' ' + row.shape);
    const Statistics sizes = sizes_of(recursive_grid(row.shape), scenes::load_scene(row.scene));
    ASSERT_EQ(sizes.more.front().first, "grids");
    const double grids = sizes.more.front().second;
    EXPECT_EQ(grids, row.ours);
    EXPECT_LE(std::abs(grids - row.published), 0.05 * row.published);
  }
}

TEST(HavranGrids, CubicGridsInVoxelsHaveThePublishedVoxels) {
  struct Row {
    const char* scene;
    GridCounts published, ours;
  };
  for (const Row& row : {Row{"balls", {16821, 8867, 34255}, {15998, 8866, 21643}},
                         Row{"tree", {16818, 11586, 21978}, {16202, 11237, 15098}}}) {
    SCOPED_TRACE(row.scene);
    const Statistics sizes = sizes_of(recursive_grid("cubic"), scenes::load_scene(row.scene));
    EXPECT_EQ((GridCounts{sizes.leaves, sizes.empty_leaves, sizes.references}), row.ours);
    expect_within(row.published.voxels, sizes.leaves, 0.05);
    expect_within(row.published.empty, sizes.empty_leaves, 0.05);
  }
}

}  // namespace
}  // namespace beambench::accel

// The number of references predicted during construction: it never exceeds the actual number, and
// structures that are too large are refused early.

#include "accel/core/least_references.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "accel/core/expected_references.hpp"
#include "accel/grid/eager_voxels.hpp"
#include "accel/grid/grid_layout.hpp"
#include "accel/octree/node_division.hpp"
#include "accel/octree/octree.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/accel/built.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

scenes::Scene one_sphere() {
  scenes::SceneBuilder builder("one sphere");
  builder.add_sphere({1.0, 2.0, 3.0}, 2.0);
  return std::move(builder).build();
}

/// Returns two spheres so close together that the finest cells on their surfaces contain both.
scenes::Scene two_spheres() {
  scenes::SceneBuilder builder("two spheres");
  builder.add_sphere({1.0, 2.0, 3.0}, 2.0);
  builder.add_sphere({1.0, 2.0, 3.0}, 1.99999);
  return std::move(builder).build();
}

std::uint64_t references_in(const scenes::Scene& scene, const CellGrid& grid) {
  Statistics statistics;
  grid::EagerVoxels(scene, grid, 1'000'000'000).describe(statistics);
  return statistics.references;
}

/// Checks cells elongated along each axis in turn, so that every projection is decisive once.
void expect_no_more_than_there_are(const scenes::Scene& scene) {
  for (const auto& cells : std::vector<std::array<int, 3>>{
           {9, 9, 9}, {40, 7, 3}, {3, 40, 7}, {7, 3, 40}, {64, 64, 64}}) {
    grid::GridLayout layout;
    layout.resolution = cells;
    const CellGrid grid = grid::make_voxel_grid(scene, layout);
    EXPECT_LE(least_references(scene, grid), static_cast<double>(references_in(scene, grid)))
        << scene.name << " " << cells[0] << "x" << cells[1] << "x" << cells[2];
  }
}

TEST(LeastReferences, NeverExceedTheActualNumber) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    expect_no_more_than_there_are(tests::random_scene(seed, 1));
    expect_no_more_than_there_are(tests::random_scene(seed, 20));
  }
  expect_no_more_than_there_are(one_sphere());
  for (const char* name : {"escena1", "tetra:n=3", "teapot:n=2", "jacks:n=2", "gears:n=1"}) {
    expect_no_more_than_there_are(scenes::load_scene(name));
  }
}

TEST(LeastReferences, OfOneConeNeverExceedTheActualNumber) {
  for (const double radius : {0.0, 0.3, 1.0, 1.9}) {
    for (const glm::dvec3& apex : std::vector<glm::dvec3>{
             {0.0, 0.0, 3.0}, {1e-6, 0.0, 0.0}, {0.1, 0.0, 0.0}, {1.0, 2.0, 3.0}}) {
      scenes::SceneBuilder builder("cone");
      builder.add_cone({0.0, 0.0, 0.0}, 2.0, apex, radius);
      expect_no_more_than_there_are(std::move(builder).build());
    }
  }
}

TEST(LeastReferences, AreCloseToTheActualNumber) {
  const scenes::Scene sphere = one_sphere();
  grid::GridLayout layout;
  layout.resolution = {100, 100, 100};
  const CellGrid grid = grid::make_voxel_grid(sphere, layout);
  EXPECT_GT(1.6 * least_references(sphere, grid), static_cast<double>(references_in(sphere, grid)));
  scenes::SceneBuilder builder("quad");
  const glm::dvec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 1}};
  builder.add_polygon(corners);
  const scenes::Scene quad = std::move(builder).build();
  const CellGrid over_quad = grid::make_voxel_grid(quad, layout);
  EXPECT_GT(8.0 * least_references(quad, over_quad),
            static_cast<double>(references_in(quad, over_quad)));
}

/// Sets the limit to the octree's own reference count, which fits, and to one less, which does not.
TEST(ReferenceLimit, RefusesNothingThatFits) {
  for (const char* name : {"escena1", "tetra:n=2", "jacks:n=1"}) {
    const scenes::Scene scene = scenes::load_scene(name);
    octree::OctreeOptions options;
    options.max_level = 8;
    const std::uint64_t references = octree::Octree(scene, options).reference_count();
    options.max_references = references;
    EXPECT_EQ(octree::Octree(scene, options).reference_count(), references) << name;
    options.max_references = references - 1;
    EXPECT_THROW(octree::Octree(scene, options), InputError) << name;
  }
}

/// Uses so many references that their number is estimated. The limit still admits the actual
/// number.
TEST(ReferenceLimit, RefusesNothingThatFitsByEstimates) {
  const scenes::Scene spheres = two_spheres();
  for (const std::string tree :
       {"gargantini:max_level=8,max_objects=1", "gargantini:max_level=8,planes=cost",
        "kd-tree:builder=median,max_depth=22,max_objects=1"}) {
    SCOPED_TRACE(tree);
    const auto with_limit = [&](std::uint64_t most) {
      const std::string spec = fmt::format("{},max_references={}", tree, most);
      return tests::build(spec, spheres)->statistics().references;
    };
    const std::uint64_t references = with_limit(50'000'000);
    EXPECT_GT(references, 100'000U);
    EXPECT_EQ(with_limit(references), references);
    EXPECT_THROW(with_limit(references - 1), InputError);
  }
}

/// The mean of many estimates is the number of references.
TEST(ExpectedReferences, AreRightOnAverage) {
  for (const char* name : {"escena1", "tetra:n=4", "jacks:n=2"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    octree::OctreeOptions options;
    options.max_level = 8;
    options.max_objects = 2;
    const octree::NodeDivision division(scene, options);
    Random random(1);
    ExpectedReferences sum;
    constexpr int kEstimates = 100;
    for (int i = 0; i < kEstimates; ++i) {
      const ExpectedReferences one = division.expected_references(options.max_level, random);
      sum.leaves += one.leaves / kEstimates;
      sum.lists += one.lists / kEstimates;
    }
    const auto references = static_cast<double>(octree::Octree(scene, options).reference_count());
    EXPECT_GT(references, 5000.0) << "too few: they would be counted one by one";
    EXPECT_NEAR(sum.leaves, references, 0.03 * references);
    EXPECT_GT(sum.lists, sum.leaves);
  }
}

/// Uses estimates with the largest possible variance: one in a thousand has the whole sum.
TEST(SurelyMoreThan, IsNotMisledByFewLargeEstimates) {
  for (const std::uint64_t most : {1'000, 1'000'000}) {
    const auto all = static_cast<double>(most);
    EXPECT_FALSE(surely_more_than(
        most, [all](Random& random) { return random.below(1000) == 0 ? 1000.0 * all : 0.0; }));
    EXPECT_FALSE(surely_more_than(most, [all](Random&) { return all; }));
    EXPECT_TRUE(surely_more_than(most, [all](Random&) { return 5.0 * all; }));
  }
}

/// Returns the processor time in seconds until the structure is built or refused, and the message.
std::pair<double, std::string> seconds_to_build(const std::string& spec,
                                                const scenes::Scene& scene) {
  const std::clock_t begin = std::clock();
  std::string message = tests::refusal(spec, scene);
  return {static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, std::move(message)};
}

/// The spheres have hundreds of millions of references in the finest cells. Without prediction, a
/// structure would be refused only after making 50 million references. Each such structure is
/// paired with a smaller one over the same scene that fits: it has about a hundred thousand.
TEST(ReferenceLimit, IsKnownToBeExceededEarly) {
  const scenes::Scene sphere = one_sphere();
  const scenes::Scene spheres = two_spheres();
  struct Case {
    std::string exceeds, fits;
    const scenes::Scene& scene;
  };
  const std::string grid = "max_voxels=2000000000,max_references=1000000";
  for (const auto& [exceeds, fits, scene] : std::vector<Case>{
           {"samet:max_level=13", "samet:max_level=8", sphere},
           {"samet:max_level=16", "samet:max_level=8", sphere},
           {"samet-net:max_level=16", "samet-net:max_level=8", sphere},
           {"glassner:max_level=15", "glassner:max_level=8", sphere},
           {"gargantini:max_level=16", "gargantini:max_level=8", sphere},
           {"beam:max_level=16", "beam:max_level=8", sphere},
           {"samet:max_level=16,assign=bbox", "samet:max_level=8", sphere},
           {"samet:max_level=16,max_objects=1", "samet:max_level=8,max_objects=1", spheres},
           {"beam:max_level=16,max_objects=1", "beam:max_level=8,max_objects=1", spheres},
           {"gargantini:max_level=16,planes=cost", "gargantini:max_level=8,planes=cost", sphere},
           {"gargantini:max_level=16,planes=cost,max_objects=1",
            "gargantini:max_level=8,planes=cost,max_objects=1", spheres},
           {"gargantini:max_level=16,build=on-demand,built_level=16",
            "gargantini:max_level=8,build=on-demand,built_level=8", sphere},
           {"gargantini:max_level=16,build=on-demand,built_level=15,planes=cost",
            "gargantini:max_level=8,build=on-demand,built_level=8,planes=cost", spheres},
           {"kd-tree:builder=median,max_depth=60,max_objects=0",
            "kd-tree:builder=median,max_depth=20,max_objects=0", sphere},
           {"kd-tree:builder=median,max_depth=50", "kd-tree:builder=median,max_depth=20", spheres},
           {"voxel-grid:resolution=1200," + grid, "voxel-grid:resolution=128," + grid, sphere},
           {"hierarchical-grid:resolution=1200," + grid, "hierarchical-grid:resolution=128," + grid,
            sphere}}) {
    SCOPED_TRACE(exceeds);
    const auto [enough, accepted] = seconds_to_build(fits, scene);
    EXPECT_EQ(accepted, "it was accepted");
    const auto [seconds, message] = seconds_to_build(exceeds, scene);
    EXPECT_NE(message.find("000000 references"), std::string::npos) << message;
    EXPECT_LT(seconds, 10.0 * enough)
        << "refused no sooner than ten builds with a hundredth of the references take";
  }
}

/// Makes a scene of equal triangles or cones in one place, which no plane divides.
scenes::Scene alike(int count, bool cones) {
  scenes::SceneBuilder builder("alike");
  const glm::dvec3 corners[] = {{0.0, 0.0, 0.0}, {1.0, 0.1, 0.2}, {0.3, 1.0, 0.7}};
  for (int i = 0; i < count; ++i) {
    if (cones) {
      builder.add_cone({0.0, 0.0, 0.0}, 0.5, {1.0, 1.0, 1.0}, 0.2);
    } else {
      builder.add_polygon(corners);
    }
  }
  return std::move(builder).build();
}

/// Seventy thousand primitives that no plane divides have a hundred times the references of seven
/// hundred such primitives, which fit. The many are refused in a fifth of the time to build them.
TEST(ReferenceLimit, IsKnownToBeExceededEarlyByPrimitivesInOnePlace) {
  for (const auto& [spec, cones] : std::vector<std::pair<std::string, bool>>{
           {"kd-tree:builder=median", false},
           {"glassner:max_objects=1", true},
           {"glassner:planes=cost", true},
           {"gargantini:planes=cost,build=on-demand,built_level=6", true}}) {
    SCOPED_TRACE(spec);
    const auto [enough, accepted] = seconds_to_build(spec, alike(700, cones));
    EXPECT_EQ(accepted, "it was accepted");
    const auto [seconds, message] = seconds_to_build(spec, alike(70'000, cones));
    EXPECT_NE(message.find("000000 references"), std::string::npos) << message;
    EXPECT_LT(seconds, 20.0 * enough);
  }
}

/// Makes a star-shaped polygon with many spikes, whose triangles are needles.
scenes::Scene star(int corners) {
  scenes::SceneBuilder builder("star");
  std::vector<glm::dvec3> places;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    const double radius = i % 2 == 0 ? 1.0 : 0.5;
    places.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
  }
  builder.add_polygon(places);
  return std::move(builder).build();
}

TEST(ReferenceLimit, IsKnownToBeExceededEarlyByASceneOfNeedles) {
  const auto [enough, accepted] = seconds_to_build("kd-tree", star(4'000));
  EXPECT_EQ(accepted, "it was accepted");
  const auto [seconds, message] = seconds_to_build("kd-tree", star(100'000));
  EXPECT_NE(message.find("more than 10000000 references"), std::string::npos) << message;
  EXPECT_LT(seconds, 15.0 * enough);
}

/// Uses so many primitives that only some of them are sampled before the tree is built. The limit
/// still admits the actual number of references.
TEST(ReferenceLimit, RefusesNothingThatFitsByParts) {
  for (const scenes::Scene& scene :
       {alike(5000, false), scenes::load_scene("bumpy:triangles=20000")}) {
    for (const std::string tree :
         {"gargantini:max_level=6,max_objects=1", "kd-tree:builder=median,max_depth=12"}) {
      SCOPED_TRACE(scene.name + " " + tree);
      const auto with_limit = [&](std::uint64_t most) {
        const std::string spec = fmt::format("{},max_references={}", tree, most);
        return tests::build(spec, scene)->statistics().references;
      };
      const std::uint64_t references = with_limit(50'000'000);
      EXPECT_EQ(with_limit(references), references);
      EXPECT_THROW(with_limit(references / 4), InputError);
    }
  }
}

TEST(RandomPart, HasEachMemberWithAProbabilityOfOneInStride) {
  std::vector<int> list(100);
  std::iota(list.begin(), list.end(), 0);
  std::vector<int> times(list.size());
  Random random(1);
  constexpr int kParts = 6000;
  std::size_t stride = 0;
  for (int i = 0; i < kParts; ++i) {
    const RandomPart part(list, random);
    stride = part.stride;
    for (const int member : part.members) ++times[static_cast<std::size_t>(member)];
  }
  ASSERT_EQ(stride, 100 / RandomPart<int>::kMembers);
  const double expected = static_cast<double>(kParts) / static_cast<double>(stride);
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (i < stride * (list.size() / stride)) {
      EXPECT_NEAR(times[i], expected, 0.2 * expected) << i;
    } else {
      EXPECT_EQ(times[i], 0) << i;
    }
  }
}

}  // namespace
}  // namespace beambench::accel

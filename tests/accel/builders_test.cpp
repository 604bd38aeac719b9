// All builders other than the binned one, and reinsertion: hierarchies are valid for any boxes and
// the same for any number of threads.

#include <array>
#include <cmath>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "accel/bvh/bvh_layout.hpp"
#include "accel/bvh/lbvh_builder.hpp"
#include "accel/bvh/morton_order.hpp"
#include "accel/bvh/ploc_builder.hpp"
#include "accel/bvh/primitive_part.hpp"
#include "accel/bvh/reinsertion.hpp"
#include "accel/bvh/sah_bvh.hpp"
#include "accel/bvh/sweep_builder.hpp"
#include "scenes/catalogue.hpp"
#include "tests/accel/binary_bvh.hpp"
#include "tests/hits_of_exhaustive.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel::bvh {
namespace {

using tests::expect_same;
using tests::expect_valid;
using tests::random_boxes;

using Boxes = std::vector<scenes::Bounds>;

struct NamedBuilder {
  const char* name;
  BinaryBvh (*build)(std::span<const scenes::Bounds>, const BvhOptions&);
};

constexpr NamedBuilder kLbvh{"Lbvh", build_lbvh};
constexpr NamedBuilder kPloc{"Ploc", build_ploc};
constexpr NamedBuilder kBinned{"Binned", build_bvh};
constexpr NamedBuilder kSweep{"Sweep", build_sweep_bvh};

/// A builder, and whether reinsertion follows.
class Builders : public ::testing::TestWithParam<std::tuple<NamedBuilder, bool>> {
 protected:
  static BinaryBvh build(const Boxes& boxes, const BvhOptions& options) {
    const auto& [builder, reinsertion] = GetParam();
    BinaryBvh bvh = builder.build(boxes, options);
    if (reinsertion) reinsert(bvh, options.parallel);
    return bvh;
  }
};
INSTANTIATE_TEST_SUITE_P(All, Builders,
                         ::testing::Combine(::testing::Values(kLbvh, kPloc, kBinned, kSweep),
                                            ::testing::Bool()),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param).name) +
                                  (std::get<1>(info.param) ? "Reinserted" : "");
                         });

/// Small leaves and full ones.
std::vector<BvhOptions> some_options() {
  std::vector<BvhOptions> all;
  for (const std::uint32_t max_leaf : {1U, 4U, 8U, 32U}) {
    for (const std::uint32_t block_size : {1U, 8U}) {
      all.push_back({.max_leaf = max_leaf, .block_size = block_size, .node_cost = 3.0F});
    }
  }
  return all;
}

/// Returns boxes that are difficult to divide.
std::vector<Boxes> difficult_boxes() {
  std::vector<Boxes> all;
  all.emplace_back(5000, scenes::Bounds{glm::vec3(1.0F), glm::vec3(2.0F)});
  Boxes spaced;  // exponentially
  for (int i = 0; i < 250; ++i) {
    const auto at = static_cast<float>(std::pow(1.7, i % 125) * 1e-28);
    spaced.push_back({glm::vec3(at), glm::vec3(at)});
  }
  all.push_back(spaced);
  Boxes nested;  // each inside the next, with a common center
  for (int i = 1; i <= 3000; ++i) {
    nested.push_back({glm::vec3(static_cast<float>(-i)), glm::vec3(static_cast<float>(i))});
  }
  all.push_back(nested);
  Boxes corner;  // each inside the next, with a common corner; sizes double
  for (int i = 0; i < 200; ++i) {
    corner.push_back(
        {glm::vec3(0.0F), glm::vec3(static_cast<float>(std::pow(2.0, i % 200 - 120)))});
  }
  all.push_back(corner);
  Boxes flat;  // in a plane
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 at(static_cast<float>(i % 50), static_cast<float>(i / 50), 0.0F);
    flat.push_back({at, at + glm::vec3(1.0F, 1.0F, 0.0F)});
  }
  all.push_back(flat);
  Boxes far;  // at the limit of coordinates, and one at the origin
  for (int i = 0; i < 100; ++i) {
    far.push_back({glm::vec3(1e9F), glm::vec3(1e9F)});
    far.push_back({glm::vec3(-1e9F), glm::vec3(-1e9F)});
  }
  far.push_back({glm::vec3(0.0F), glm::vec3(1e-30F)});
  all.push_back(far);
  return all;
}

TEST_P(Builders, HoldEveryBoxOnce) {
  for (const std::size_t count : {1U, 2U, 3U, 7U, 9U, 100U, 5000U}) {
    const Boxes boxes = random_boxes(count, count);
    for (const BvhOptions& options : some_options()) {
      SCOPED_TRACE(::testing::Message() << count << " boxes, leaves of " << options.max_leaf);
      expect_valid(build(boxes, options), boxes, options);
    }
  }
  EXPECT_TRUE(build({}, {}).nodes.empty());
}

TEST_P(Builders, BoundTheDepthForAnyBoxes) {
  for (const Boxes& boxes : difficult_boxes()) {
    for (const BvhOptions& options : some_options()) {
      SCOPED_TRACE(::testing::Message() << boxes.size() << " boxes, " << options.max_leaf);
      expect_valid(build(boxes, options), boxes, options);
    }
  }
}

TEST_P(Builders, AreTheSameInParallel) {
  std::vector<Boxes> all = difficult_boxes();
  all.push_back(random_boxes(100'000, 9));
  for (const Boxes& boxes : all) {
    SCOPED_TRACE(boxes.size());
    for (BvhOptions options : {BvhOptions{}, BvhOptions{.block_size = 1, .node_cost = 3.0F}}) {
      const BinaryBvh serial = build(boxes, options);
      options.parallel = true;
      expect_same(serial, build(boxes, options));
    }
  }
}

TEST_P(Builders, KeepItemsOfASubtreeContiguous) {
  const Boxes boxes = random_boxes(3000, 5);
  const BinaryBvh bvh = build(boxes, {});
  std::vector<std::uint32_t> first(bvh.nodes.size());
  std::vector<std::uint32_t> end(bvh.nodes.size());
  for (std::size_t i = bvh.nodes.size(); i-- > 0;) {
    const BvhNode& node = bvh.nodes[i];
    if (!node.is_leaf()) {
      ASSERT_EQ(end[node.first], first[node.first + 1]);
    }
    first[i] = node.is_leaf() ? node.first : first[node.first];
    end[i] = node.is_leaf() ? node.first + node.count : end[node.first + 1];
  }
}

Boxes boxes_of(const char* scene_name) {
  const scenes::Scene scene = scenes::load_scene(scene_name);
  return padded_boxes(scene, collect_parts(scene));
}

TEST(SweepBuilder, CostsNoMoreThanBins) {
  for (const char* scene : {"bumpy:triangles=20000", "balls:n=4", "rings:n=3", "escena1"}) {
    SCOPED_TRACE(scene);
    const Boxes boxes = boxes_of(scene);
    // Each split is the best for its node, but not necessarily for the whole tree.
    EXPECT_LE(sah_cost(build_sweep_bvh(boxes, {}), {}), 1.02 * sah_cost(build_bvh(boxes, {}), {}));
  }
}

TEST(SweepBuilder, FindsTheBestSplit) {
  // Sixteen boxes in a row, with a gap in the middle.
  Boxes boxes;
  for (int i = 0; i < 16; ++i) {
    const auto at = static_cast<float>(i) + (i < 8 ? 0.0F : 0.5F);
    boxes.push_back({glm::vec3(at), glm::vec3(at + 1.0F)});
  }
  const BinaryBvh bvh = build_sweep_bvh(boxes, {});
  ASSERT_EQ(bvh.nodes.size(), 3U);
  EXPECT_EQ(bvh.nodes[1].count, 8U);
}

TEST(PlocBuilder, MergesNeighbors) {
  // Two pairs of neighbors: of all trees, the one with these pairs has the least area.
  const auto at = [](float x) {
    return scenes::Bounds{glm::vec3(x, 0, 0), glm::vec3(x + 1, 1, 1)};
  };
  const BinaryBvh bvh = build_ploc(Boxes{at(0), at(10), at(1.5), at(12)}, {.max_leaf = 1});
  ASSERT_EQ(bvh.nodes.size(), 7U);
  EXPECT_EQ(bvh.items, (std::vector<std::uint32_t>{0, 2, 1, 3}));
}

TEST(MortonOrder, DividesTheLongestSideFirst) {
  Boxes boxes;  // twice as long as wide, and flat
  for (const glm::vec3& at : {glm::vec3(0, 0, 0), glm::vec3(8, 0, 0), glm::vec3(0, 3, 0),
                              glm::vec3(8, 3, 0), glm::vec3(2, 0, 0.01F)}) {
    boxes.push_back({at, at});
  }
  const auto keys = morton_order(boxes, false);
  ASSERT_EQ(keys.size(), 5U);
  std::vector<std::uint32_t> order;
  for (const MortonKey key : keys) order.push_back(index_of(key));
  EXPECT_EQ(order, (std::vector<std::uint32_t>{0, 2, 4, 1, 3}));
  for (const MortonKey key : keys) EXPECT_LT(code_of(key), 1U << 30U);
}

TEST(Reinsertion, NeverCostsMore) {
  for (const NamedBuilder& builder : {kLbvh, kPloc, kBinned, kSweep}) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
      SCOPED_TRACE(::testing::Message() << builder.name << ' ' << seed);
      const Boxes boxes = random_boxes(10 + 40 * seed, seed);
      BinaryBvh bvh = builder.build(boxes, {});
      const double before = sah_cost(bvh, {});
      reinsert(bvh, false);
      EXPECT_LE(sah_cost(bvh, {}), before);
    }
    for (const Boxes& boxes : difficult_boxes()) {
      BinaryBvh bvh = builder.build(boxes, {.max_leaf = 2});
      const double before = sah_cost(bvh, {});
      reinsert(bvh, false);
      EXPECT_LE(sah_cost(bvh, {}), before);
    }
  }
}

TEST(Reinsertion, RepairsABadTree) {
  const Boxes boxes = random_boxes(300, 3);
  const BinaryBvh good = build_sweep_bvh(boxes, {.max_leaf = 1});
  // The bad tree has the same nodes, but its leaves hold the boxes in their order, which is random.
  BinaryBvh bad = good;
  for (std::size_t i = bad.nodes.size(), item = 0; i-- > 0;) {
    BvhNode& node = bad.nodes[i];
    if (node.is_leaf()) {
      bad.items[node.first] = static_cast<std::uint32_t>(item++);
      node.box = boxes[bad.items[node.first]];
    } else {
      node.box = scenes::Bounds{};
      node.box.include(bad.nodes[node.first].box);
      node.box.include(bad.nodes[node.first + 1].box);
    }
  }
  BinaryBvh repaired = bad;
  reinsert(repaired, false);
  EXPECT_LT(sah_cost(repaired, {}), 0.5 * sah_cost(bad, {}));
  expect_valid(repaired, boxes, {.max_leaf = 1});
}

TEST(MergedLeaves, AreAsLargeAsAllowedIfTheyPay) {
  const Boxes boxes = random_boxes(2000, 6);
  BinaryBvh bvh = build_bvh(boxes, {.max_leaf = 1});
  merge_leaves(bvh, {});
  expect_valid(bvh, boxes, {});
  EXPECT_LT(bvh.nodes.size(), 1000U);
  EXPECT_LT(sah_cost(bvh, {}), sah_cost(build_bvh(boxes, {.max_leaf = 1}), {}));
}

/// Builder, reinsertion and collapse of a whole structure.
class BuiltStructures : public ::testing::TestWithParam<std::tuple<BvhBuilder, bool, BvhCollapse>> {
 protected:
  static SahBvhOptions options() {
    const auto& [builder, reinsertion, collapse] = GetParam();
    return {{{}, builder, collapse, reinsertion}};
  }
};
INSTANTIATE_TEST_SUITE_P(
    All, BuiltStructures,
    ::testing::Combine(::testing::Values(BvhBuilder::kLbvh, BvhBuilder::kPloc, BvhBuilder::kBinned,
                                         BvhBuilder::kSweep, BvhBuilder::kSpatial),
                       ::testing::Bool(),
                       ::testing::Values(BvhCollapse::kArea, BvhCollapse::kCost)),
    [](const auto& info) {
      constexpr auto kNames = std::to_array({"Lbvh", "Ploc", "Binned", "Sweep", "Spatial"});
      return std::string(kNames[static_cast<std::size_t>(std::get<0>(info.param))]) +
             (std::get<1>(info.param) ? "Reinserted" : "") +
             (std::get<2>(info.param) == BvhCollapse::kArea ? "ByArea" : "ByCost");
    });

TEST_P(BuiltStructures, MatchExhaustive) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 10 + 8 * static_cast<int>(seed));
    tests::expect_hits_of_exhaustive(scene, SahBvh(scene, options()), seed, 120);
  }
}

TEST_P(BuiltStructures, LoseNoHitsOnMeshes) {
  for (const char* name : {"bumpy:triangles=3072", "balls:n=3"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    tests::expect_hits_of_exhaustive(scene, SahBvh(scene, options()), 11, 500);
  }
}

TEST_P(BuiltStructures, AreTheSameInParallel) {
  const scenes::Scene scene = scenes::load_scene("bumpy:triangles=12288");
  SahBvhOptions options = BuiltStructures::options();
  const SahBvh serial(scene, options);
  options.splits.parallel = true;
  const SahBvh parallel(scene, options);
  EXPECT_EQ(serial.bvh().cost, parallel.bvh().cost);
  EXPECT_EQ(serial.bvh().leaves, parallel.bvh().leaves);
  ASSERT_EQ(serial.bvh().nodes.size(), parallel.bvh().nodes.size());
  for (std::size_t i = 0; i < serial.bvh().nodes.size(); ++i) {
    ASSERT_EQ(serial.bvh().nodes[i].planes, parallel.bvh().nodes[i].planes);
  }
}

}  // namespace
}  // namespace beambench::accel::bvh

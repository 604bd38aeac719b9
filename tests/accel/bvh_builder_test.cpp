// The SAH builder in isolation: the properties that all its users rely on.

#include "accel/bvh/bvh_builder.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/accel/binary_bvh.hpp"
#include "tests/accel/contains.hpp"

namespace beambench::accel {
namespace {

using tests::expect_same;
using tests::expect_valid;
using tests::random_boxes;

TEST(BvhBuilder, HoldsEveryBoxOnce) {
  for (const std::size_t count : {1U, 2U, 7U, 8U, 9U, 100U, 5000U}) {
    for (const std::uint32_t max_leaf : {1U, 4U, 8U, 32U}) {
      SCOPED_TRACE(::testing::Message() << count << " boxes, leaves of " << max_leaf);
      const auto boxes = random_boxes(count, count);
      bvh::BvhOptions options;
      options.max_leaf = max_leaf;
      expect_valid(bvh::build_bvh(boxes, options), boxes, options);
    }
  }
}

TEST(BvhBuilder, NoBoxesYieldNoNodes) {
  const bvh::BinaryBvh bvh = bvh::build_bvh({}, {});
  EXPECT_TRUE(bvh.nodes.empty());
  EXPECT_EQ(bvh::sah_cost(bvh, {}), 0.0);
}

TEST(BvhBuilder, DividedLeavesHoldEveryBoxOnce) {
  for (const std::size_t count : {std::size_t{1}, std::size_t{30}, std::size_t{3000}}) {
    const std::vector<scenes::Bounds> boxes = random_boxes(count, count);
    bvh::BvhOptions coarse;
    coarse.max_leaf = 32;
    coarse.block_size = 16;
    const bvh::BinaryBvh whole = bvh::build_bvh(boxes, coarse);
    bvh::BvhOptions fine;
    fine.max_leaf = 4;
    fine.block_size = 1;
    bvh::BinaryBvh divided = whole;
    bvh::divide_leaves(divided, boxes, fine);
    expect_valid(divided, boxes, fine);
    for (std::size_t i = 0; i < whole.nodes.size(); ++i) {
      EXPECT_EQ(divided.nodes[i].box.lower, whole.nodes[i].box.lower);
      EXPECT_TRUE(whole.nodes[i].is_leaf() || divided.nodes[i].first == whole.nodes[i].first);
    }
    bvh::BinaryBvh in_parallel = whole;
    fine.parallel = true;
    bvh::divide_leaves(in_parallel, boxes, fine);
    EXPECT_EQ(in_parallel.items, divided.items);
    EXPECT_EQ(in_parallel.nodes.size(), divided.nodes.size());
    EXPECT_EQ(in_parallel.depth, divided.depth);
  }
}

TEST(BvhBuilder, IsTheSameBuiltInParallel) {
  const auto boxes = random_boxes(200'000, 9);
  bvh::BvhOptions options;
  const bvh::BinaryBvh serial = bvh::build_bvh(boxes, options);
  options.parallel = true;
  const bvh::BinaryBvh parallel = bvh::build_bvh(boxes, options);
  expect_same(serial, parallel);
}

// One library ignored the bins of two axes for two years, with every hit correct.
TEST(BvhBuilder, NoAxisIsPreferred) {
  const auto boxes = random_boxes(3000, 4);
  std::vector<double> costs;
  for (int turn = 0; turn < 3; ++turn) {
    std::vector<scenes::Bounds> turned;
    for (const scenes::Bounds& box : boxes) {
      const auto turned_point = [&](const glm::vec3& p) {
        return glm::vec3(p[turn], p[(turn + 1) % 3], p[(turn + 2) % 3]);
      };
      turned.push_back({turned_point(box.lower), turned_point(box.upper)});
    }
    costs.push_back(bvh::sah_cost(bvh::build_bvh(turned, {}), {}));
  }
  EXPECT_NEAR(costs[1], costs[0], 0.01 * costs[0]);
  EXPECT_NEAR(costs[2], costs[0], 0.01 * costs[0]);
}

TEST(BvhBuilder, SplitsByAreaAndNotByCount) {
  // Eight boxes at one end, one far away: splitting at the middle item is the worst choice.
  std::vector<scenes::Bounds> boxes;
  for (int i = 0; i < 8; ++i) {
    const auto at = static_cast<float>(i) * 0.01F;
    boxes.push_back({glm::vec3(at), glm::vec3(at + 0.01F)});
  }
  boxes.push_back({glm::vec3(10.0F), glm::vec3(11.0F)});
  const bvh::BinaryBvh bvh = bvh::build_bvh(boxes, {});
  ASSERT_EQ(bvh.nodes.size(), 3U);
  EXPECT_EQ(bvh.nodes[1].count, 8U);
  EXPECT_EQ(bvh.nodes[2].count, 1U);
}

TEST(BvhBuilder, CoincidentBoxesAreSplitInHalf) {
  const std::vector<scenes::Bounds> boxes(10'000, scenes::Bounds{glm::vec3(1.0F), glm::vec3(2.0F)});
  const bvh::BvhOptions options;
  const bvh::BinaryBvh bvh = bvh::build_bvh(boxes, options);
  expect_valid(bvh, boxes, options);
  EXPECT_LE(bvh.depth, 12U) << "1 + log2(10,000 / 8)";
}

TEST(BvhBuilder, DepthIsBoundedForAnyBoxes) {
  std::vector<scenes::Bounds> boxes;  // each split removes only the few largest
  for (int i = 0; i < 250; ++i) {
    const auto at = static_cast<float>(std::pow(1.7, i % 125) * 1e-28);
    boxes.push_back({glm::vec3(at), glm::vec3(at)});
  }
  bvh::BvhOptions options;
  options.max_leaf = 1;
  expect_valid(bvh::build_bvh(boxes, options), boxes, options);
}

TEST(BvhBuilder, GatheredChildrenCoverTheNode) {
  const auto boxes = random_boxes(3000, 2);
  const bvh::BinaryBvh bvh = bvh::build_bvh(boxes, {});
  for (const std::size_t width : {2U, 4U, 8U, 16U}) {
    std::vector<std::uint32_t> children(width);
    const std::size_t count = bvh::gather_children(bvh, 0, children);
    EXPECT_EQ(count, width);
    scenes::Bounds together;
    for (const std::uint32_t child : children) {
      EXPECT_TRUE(tests::contains(bvh.nodes[0].box, bvh.nodes[child].box));
      together.include(bvh.nodes[child].box);
    }
    EXPECT_EQ(together.lower, bvh.nodes[0].box.lower);
    EXPECT_EQ(together.upper, bvh.nodes[0].box.upper);
    std::sort(children.begin(), children.end());
    EXPECT_EQ(std::unique(children.begin(), children.end()), children.end());
  }
}

}  // namespace
}  // namespace beambench::accel

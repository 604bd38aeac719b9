#pragma once
// Checks for the binary hierarchies of all builders.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "accel/bvh/bvh_builder.hpp"
#include "scenes/base/random.hpp"

namespace beambench::tests {

/// Returns small boxes in the unit cube.
inline std::vector<scenes::Bounds> random_boxes(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<scenes::Bounds> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 lower{random.unit(), random.unit(), random.unit()};
    const glm::vec3 size{random.unit(), random.unit(), random.unit()};
    boxes.push_back({lower, lower + size * 0.02F});
  }
  return boxes;
}

/// Expects every box once, in a leaf of an allowed size, and every node's box to be the union of
/// the boxes below.
inline void expect_valid(const accel::bvh::BinaryBvh& bvh, const std::vector<scenes::Bounds>& boxes,
                         const accel::bvh::BvhOptions& options) {
  ASSERT_EQ(bvh.items.size(), boxes.size());
  std::vector<std::uint32_t> items = bvh.items;
  std::sort(items.begin(), items.end());
  for (std::uint32_t i = 0; i < items.size(); ++i) ASSERT_EQ(items[i], i);

  std::vector<int> parents(bvh.nodes.size(), 0);
  std::size_t in_leaves = 0;
  for (std::uint32_t i = 0; i < bvh.nodes.size(); ++i) {
    const accel::bvh::BvhNode& node = bvh.nodes[i];
    scenes::Bounds below;
    if (node.is_leaf()) {
      EXPECT_LE(node.count, options.max_leaf);
      in_leaves += node.count;
      for (std::uint32_t k = 0; k < node.count; ++k) {
        below.include(boxes[bvh.items[node.first + k]]);
      }
    } else {
      ASSERT_GT(node.first, i);
      ASSERT_LT(node.first + 1, bvh.nodes.size());
      for (const std::uint32_t child : {node.first, node.first + 1}) {
        below.include(bvh.nodes[child].box);
        ++parents[child];
      }
    }
    EXPECT_EQ(below.lower, node.box.lower);
    EXPECT_EQ(below.upper, node.box.upper);
  }
  EXPECT_EQ(in_leaves, boxes.size());
  EXPECT_EQ(std::count(parents.begin(), parents.end(), 1),
            static_cast<std::ptrdiff_t>(bvh.nodes.size()) - 1);
  EXPECT_LE(bvh.depth, accel::bvh::kMaxBvhDepth);
}

inline void expect_same(const accel::bvh::BinaryBvh& a, const accel::bvh::BinaryBvh& b) {
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.items, b.items);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    ASSERT_EQ(a.nodes[i].first, b.nodes[i].first);
    ASSERT_EQ(a.nodes[i].count, b.nodes[i].count);
    ASSERT_EQ(a.nodes[i].box.lower, b.nodes[i].box.lower);
    ASSERT_EQ(a.nodes[i].box.upper, b.nodes[i].box.upper);
  }
}

}  // namespace beambench::tests

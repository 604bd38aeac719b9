#include "accel/bvh/stream_tree.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "accel/core/padded_bounds.hpp"

namespace beambench::accel::bvh {
namespace {

/// The minimum size of a triangle in error estimates, so that they cover float products that
/// underflow.
constexpr double kLeastSize = 0x1p-60;

/// Boxes are widened by this share of the tree's size.
constexpr double kSlack = 0x1p-18;

StreamNode stream_node(const WideNode& from, const StreamTree& tree) {
  StreamNode node{};
  node.count = from.count();
  node.children = from.children;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto origin = static_cast<double>(tree.center[static_cast<int>(axis)]);
    for (std::size_t lane = 0; lane < kBvhLanes; ++lane) {
      if (lane >= node.count) {
        node.half[axis][lane] = -0x1p90F;
        continue;
      }
      const double lower = from.planes[axis][lane] - origin;
      const double upper = from.planes[axis + 3][lane] - origin;
      const auto center = static_cast<float>(0.5 * (lower + upper));
      const double half = std::max(upper - center, center - lower) + kSlack * tree.half_size;
      node.center[axis][lane] = center;
      node.half[axis][lane] = next_above(static_cast<float>(half));
    }
  }
  return node;
}

StreamBlock stream_block(const PrimitiveBlock& block) {
  StreamBlock to{};
  to.kind = block.kind;
  to.count = block.count;
  to.first = block.first;
  to.leaf_extent = block.leaf_extent;
  if (block.kind != scenes::PrimitiveKind::kPolygon) return to;
  for (std::size_t lane = 0; lane < block.count; ++lane) {
    const auto put = [lane](auto& row, const glm::dvec3& v) {
      for (int axis = 0; axis < 3; ++axis) {
        row[static_cast<std::size_t>(axis)][lane] = static_cast<float>(v[axis]);
      }
    };
    const glm::dvec3 a(block.corner(0, lane));
    const glm::dvec3 b(block.corner(1, lane));
    const glm::dvec3 c(block.corner(2, lane));
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const glm::dvec3 sides = glm::max(glm::max(a, b), c) - glm::min(glm::min(a, b), c);
    const double side = std::max({sides.x, sides.y, sides.z});
    const double sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
    put(to.a, a);
    put(to.from_c, a - c);
    put(to.to_b, b - a);
    put(to.normal, normal);
    to.size[lane] = next_above(static_cast<float>(std::max({sum, side * side / 8.0, kLeastSize})));
  }
  return to;
}

void put_triangles(const PrimitiveBlock& block, LargePageVector<WholeTriangle>& triangles) {
  if (block.kind != scenes::PrimitiveKind::kPolygon) return;
  for (std::size_t lane = 0; lane < block.count; ++lane) {
    triangles[block.first + lane] = {block.corner(0, lane), block.primitives[lane],
                                     block.corner(1, lane), 0.0F,
                                     block.corner(2, lane), 0.0F};
  }
}

}  // namespace

StreamTree build_stream_tree(const WideBvh& bvh, bool parallel, StreamTree memory) {
  StreamTree tree = std::move(memory);
  if (bvh.empty()) return {};
  // The root's box is included, because the scene's bounds lack the padding.
  scenes::Bounds bounds = bvh.scene_bounds;
  if (!bvh.root.is_leaf()) bounds.include(bvh.nodes[bvh.root.node_index()].bounds());
  tree.center = glm::vec3(0.5 * (glm::dvec3(bounds.lower) + glm::dvec3(bounds.upper)));
  const glm::dvec3 center(tree.center);
  const glm::dvec3 reach =
      glm::max(glm::dvec3(bounds.upper) - center, center - glm::dvec3(bounds.lower));
  tree.half_size = next_above(static_cast<float>(std::max({reach.x, reach.y, reach.z})));
  const glm::vec3 sizes = glm::abs(tree.center);
  tree.center_size = std::max({sizes.x, sizes.y, sizes.z});
  tree.nodes.resize(bvh.nodes.size());
  tree.blocks.resize(bvh.blocks.size());
  tree.triangles.resize(bvh.blocks.back().first + bvh.blocks.back().count);
  const auto for_all = [&](std::size_t count, const auto& fill) {
    const auto fill_range = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) fill(i);
    };
    if (!parallel) return fill_range(0, count);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1024),
                      [&](const auto& range) { fill_range(range.begin(), range.end()); });
  };
  for_all(tree.nodes.size(),
          [&](std::size_t i) { tree.nodes[i] = stream_node(bvh.nodes[i], tree); });
  for_all(tree.blocks.size(), [&](std::size_t i) {
    tree.blocks[i] = stream_block(bvh.blocks[i]);
    put_triangles(bvh.blocks[i], tree.triangles);
  });
  return tree;
}

}  // namespace beambench::accel::bvh

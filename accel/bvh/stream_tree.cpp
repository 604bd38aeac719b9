#include "accel/bvh/stream_tree.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "accel/core/padded_bounds.hpp"

namespace beambench::accel::bvh {
namespace {

/// Normals shorter than this count as of this length where errors are estimated, so that products
/// of floats that underflow are among the errors.
constexpr double kShortestNormal = 0x1p-60;

/// The share of the tree's size by which boxes are widened.
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

BlockNormals block_normals(const PrimitiveBlock& block) {
  BlockNormals normals{};
  if (block.kind != scenes::PrimitiveKind::kPolygon) return normals;
  for (std::size_t lane = 0; lane < block.count; ++lane) {
    const glm::dvec3 a(block.corner(0, lane));
    const glm::dvec3 normal =
        glm::cross(glm::dvec3(block.corner(1, lane)) - a, glm::dvec3(block.corner(2, lane)) - a);
    for (int axis = 0; axis < 3; ++axis) {
      normals.rows[static_cast<std::size_t>(axis)][lane] = static_cast<float>(normal[axis]);
    }
    const double sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
    normals.rows[3][lane] = static_cast<float>(std::max(sum, kShortestNormal));
  }
  return normals;
}

}  // namespace

StreamTree build_stream_tree(const WideBvh& bvh, bool parallel) {
  StreamTree tree;
  if (bvh.empty()) return tree;
  // The root's box: that of the scene's bounds is less by the padding.
  scenes::Bounds bounds = bvh.scene_bounds;
  if (!bvh.root.is_leaf()) {
    const WideNode& root = bvh.nodes[bvh.root.node_index()];
    for (std::size_t lane = 0; lane < root.count(); ++lane) {
      const auto& plane = root.planes;
      bounds.include(glm::vec3(plane[0][lane], plane[1][lane], plane[2][lane]));
      bounds.include(glm::vec3(plane[3][lane], plane[4][lane], plane[5][lane]));
    }
  }
  tree.center = glm::vec3(0.5 * (glm::dvec3(bounds.lower) + glm::dvec3(bounds.upper)));
  const glm::dvec3 center(tree.center);
  const glm::dvec3 reach =
      glm::max(glm::dvec3(bounds.upper) - center, center - glm::dvec3(bounds.lower));
  tree.half_size = next_above(static_cast<float>(std::max({reach.x, reach.y, reach.z})));
  tree.nodes.resize(bvh.nodes.size());
  tree.normals.resize(bvh.blocks.size());
  const auto fill = [&](auto& to, const auto& from, const auto& make) {
    const auto fill_range = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) to[i] = make(from[i]);
    };
    if (!parallel) return fill_range(0, to.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, to.size(), 1024),
                      [&](const auto& range) { fill_range(range.begin(), range.end()); });
  };
  fill(tree.nodes, bvh.nodes, [&](const WideNode& node) { return stream_node(node, tree); });
  fill(tree.normals, bvh.blocks, block_normals);
  return tree;
}

}  // namespace beambench::accel::bvh

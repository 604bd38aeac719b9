#include "accel/bvh/refit.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "accel/bvh/box_quads.hpp"
#include "accel/core/padded_bounds.hpp"
#include "accel/core/tolerance.hpp"

namespace beambench::accel::bvh {
namespace {

/// Copies the coordinates of a block's primitives from the scene and returns their box without
/// widening it. Raises `extent` to the longest side of a triangle's box if that is larger.
QuadBox refill(PrimitiveBlock& block, const scenes::Scene& scene, float& extent) {
  QuadBox box = QuadBox::empty();
  for (std::size_t lane = 0; lane < block.count; ++lane) {
    copy_coordinates(scene, lane, block);
    if (block.kind == scenes::PrimitiveKind::kPolygon) {
      QuadBox own = QuadBox::empty();
      for (std::size_t i = 0; i < 3; ++i) own.include(quad_of(block.corner(i, lane)));
      const Quad sides = own.upper - own.lower;
      extent = std::max({extent, sides[0], sides[1], sides[2]});
      box.include(own);
    } else {
      const scenes::Bounds bounds = scenes::primitive_bounds(scene, block.primitives[lane]);
      box.include(QuadBox{quad_of(bounds.lower), quad_of(bounds.upper)});
      const glm::vec3 sides = bounds.extent();
      extent = std::max({extent, sides.x, sides.y, sides.z});
    }
  }
  return box;
}

/// Copies the coordinates of a leaf's primitives, and returns its box.
scenes::Bounds refill_leaf(WideBvh& bvh, const scenes::Scene& scene, ChildReference leaf,
                           double tolerance) {
  QuadBox box = QuadBox::empty();
  float extent = 0.0F;
  const std::size_t end = leaf.first_block() + leaf.block_count();
  for (std::size_t i = leaf.first_block(); i < end; ++i) {
    box.include(refill(bvh.blocks[i], scene, extent));
  }
  for (std::size_t i = leaf.first_block(); i < end; ++i) bvh.blocks[i].leaf_extent = extent;
  return padded(box.bounds(), tolerance);
}

}  // namespace

void refit(InsertionHierarchy& hierarchy, const scenes::Scene& scene) {
  const double tolerance = overlap_tolerance(scene);
  auto& entries = hierarchy.entries;
  for (std::size_t i = entries.size(); i-- > 0;) {  // an entry's subtree follows it
    HierarchyEntry& entry = entries[i];
    if (!entry.is_volume()) {
      entry.box = padded(scenes::primitive_bounds(scene, entry.primitive), tolerance);
      continue;
    }
    entry.box = {};
    for (std::size_t child = i + 1; child < entry.end; child = entries[child].end) {
      entry.box.include(entries[child].box);
    }
  }
  hierarchy.cost = hierarchy_cost(entries);
}

void refit(WideBvh& bvh, const scenes::Scene& scene, bool parallel) {
  bvh.scene_bounds = scene.bounds;
  bvh.is_refit = true;
  const double tolerance = overlap_tolerance(scene);
  if (bvh.empty()) return;
  if (bvh.root.is_leaf()) {
    refill_leaf(bvh, scene, bvh.root, tolerance);
    return;
  }
  const auto refill_leaves = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      WideNode& node = bvh.nodes[i];
      for (std::size_t lane = 0, count = node.count(); lane < count; ++lane) {
        const ChildReference child = node.children[lane];
        if (child.is_leaf()) {
          node.set_box(lane, refill_leaf(bvh, scene, child, tolerance));
        }
      }
    }
  };
  if (parallel) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, bvh.nodes.size(), 256),
                      [&](const auto& range) { refill_leaves(range.begin(), range.end()); });
  } else {
    refill_leaves(0, bvh.nodes.size());
  }
  for (std::size_t i = bvh.nodes.size(); i-- > 0;) {  // children come after their parents
    WideNode& node = bvh.nodes[i];
    for (std::size_t lane = 0, count = node.count(); lane < count; ++lane) {
      const ChildReference child = node.children[lane];
      if (!child.is_leaf()) node.set_box(lane, bvh.nodes[child.node_index()].bounds());
    }
  }
}

}  // namespace beambench::accel::bvh

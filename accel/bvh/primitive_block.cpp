#include "accel/bvh/primitive_block.hpp"

#include <algorithm>

namespace beambench::accel::bvh {
namespace {

void append(const scenes::Scene& scene, const PrimitivePart& piece, PrimitiveBlock& block) {
  const std::size_t lane = block.count++;
  block.primitives[lane] = piece.primitive;
  block.parts[lane] = piece.index;
  copy_coordinates(scene, lane, block);
}

/// Returns the longest side of the boxes of a block's triangles.
float longest_side(const PrimitiveBlock& block) {
  float longest = 0.0F;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& a = block.coordinates[axis];
    const auto& b = block.coordinates[axis + 3];
    const auto& c = block.coordinates[axis + 6];
    for (std::size_t lane = 0; lane < block.count; ++lane) {
      const float lower = std::min({a[lane], b[lane], c[lane]});
      longest = std::max(longest, std::max({a[lane], b[lane], c[lane]}) - lower);
    }
  }
  return longest;
}

float longest_side(const scenes::Bounds& box) {
  const glm::vec3 sides = box.extent();
  return std::max({sides.x, sides.y, sides.z});
}

}  // namespace

void append_blocks(const scenes::Scene& scene, std::span<const PrimitivePart> pieces,
                   LargePageVector<PrimitiveBlock>& blocks) {
  const std::size_t begin = blocks.size();
  float extent = 0.0F;
  const bool only_polygons = scene.spheres.empty() && scene.cones.empty();
  for (const scenes::PrimitiveKind kind :
       {scenes::PrimitiveKind::kPolygon, scenes::PrimitiveKind::kSphere,
        scenes::PrimitiveKind::kCone}) {
    PrimitiveBlock* block = nullptr;
    for (const PrimitivePart& piece : pieces) {
      // Looking up the kind would cost a cache miss for each triangle.
      if (!only_polygons && scene.primitives[piece.primitive].kind != kind) continue;
      if (block == nullptr || block->count == kBvhLanes) {
        const std::uint32_t first = blocks.empty() ? 0 : blocks.back().first + blocks.back().count;
        block = &blocks.emplace_back();
        block->kind = kind;
        block->first = first;
      }
      append(scene, piece, *block);
      if (kind != scenes::PrimitiveKind::kPolygon) {
        extent = std::max(extent, longest_side(part_bounds(scene, piece)));
      }
    }
    if (only_polygons) break;
  }
  const auto added = std::span(blocks).subspan(begin);
  for (const PrimitiveBlock& block : added) {
    if (block.kind == scenes::PrimitiveKind::kPolygon)
      extent = std::max(extent, longest_side(block));
  }
  for (PrimitiveBlock& block : added) block.leaf_extent = extent;
}

}  // namespace beambench::accel::bvh

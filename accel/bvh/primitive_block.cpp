#include "accel/bvh/primitive_block.hpp"

namespace beambench::accel::bvh {
namespace {

void append(const scenes::Scene& scene, const PrimitivePart& piece, PrimitiveBlock& block) {
  const std::size_t lane = block.count++;
  block.primitives[lane] = piece.primitive;
  block.parts[lane] = piece.index;
  if (block.kind == scenes::PrimitiveKind::kPolygon) {
    for (std::size_t i = 0; i < 3; ++i) {
      block.put(3 * i, lane, scene.vertices[scene.triangles[piece.index].vertex[i]]);
    }
  } else if (block.kind == scenes::PrimitiveKind::kSphere) {
    block.put(0, lane, scene.spheres[piece.index].center);
    block.coordinates[3][lane] = scene.spheres[piece.index].radius;
  }
}

}  // namespace

void append_blocks(const scenes::Scene& scene, std::span<const PrimitivePart> pieces, float extent,
                   LargePageVector<PrimitiveBlock>& blocks) {
  for (const scenes::PrimitiveKind kind :
       {scenes::PrimitiveKind::kPolygon, scenes::PrimitiveKind::kSphere,
        scenes::PrimitiveKind::kCone}) {
    PrimitiveBlock* block = nullptr;
    for (const PrimitivePart& piece : pieces) {
      if (scene.primitives[piece.primitive].kind != kind) continue;
      if (block == nullptr || block->count == kBvhLanes) {
        const std::uint32_t first = blocks.empty() ? 0 : blocks.back().first + blocks.back().count;
        block = &blocks.emplace_back();
        block->kind = kind;
        block->first = first;
        block->leaf_extent = extent;
      }
      append(scene, piece, *block);
    }
  }
}

}  // namespace beambench::accel::bvh

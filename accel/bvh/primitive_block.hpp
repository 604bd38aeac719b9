#pragma once
// Primitives in blocks of eight for SIMD tests.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "accel/bvh/primitive_part.hpp"
#include "accel/core/large_pages.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::bvh {

/// The number of children of a node and of primitives of a block, each in a SIMD lane.
inline constexpr std::size_t kBvhLanes = 8;

/// Up to eight primitives of one kind.
struct alignas(64) PrimitiveBlock {
  /// Triangles (kind kPolygon): the coordinates of three corners, corner by corner. Spheres: the
  /// center's coordinates and the radius. Cones: nothing.
  std::array<std::array<float, kBvhLanes>, 9> coordinates;
  std::array<scenes::PrimitiveId, kBvhLanes> primitives;  ///< for a triangle, its polygon
  std::array<std::uint32_t, kBvhLanes> parts;             ///< the same as `PrimitivePart::index`
  scenes::PrimitiveKind kind;
  std::uint32_t count;
  std::uint32_t first;  ///< number of primitives in the blocks before it
  float leaf_extent;    ///< the longest side of the boxes of the leaf's pieces

  glm::vec3 corner(std::size_t which, std::size_t lane) const {
    const std::size_t row = 3 * which;
    return {coordinates[row][lane], coordinates[row + 1][lane], coordinates[row + 2][lane]};
  }
  void put(std::size_t first_row, std::size_t lane, const glm::vec3& point) {
    for (int axis = 0; axis < 3; ++axis) {
      coordinates[first_row + static_cast<std::size_t>(axis)][lane] = point[axis];
    }
  }
};

/// Copies the coordinates of the part in a lane from the scene.
inline void copy_coordinates(const scenes::Scene& scene, std::size_t lane, PrimitiveBlock& block) {
  const std::uint32_t part = block.parts[lane];
  if (block.kind == scenes::PrimitiveKind::kPolygon) {
    for (std::size_t i = 0; i < 3; ++i) {
      block.put(3 * i, lane, scene.vertices[scene.triangles[part].vertex[i]]);
    }
  } else if (block.kind == scenes::PrimitiveKind::kSphere) {
    block.put(0, lane, scene.spheres[part].center);
    block.coordinates[3][lane] = scene.spheres[part].radius;
  }
}

/// Appends the blocks of one leaf. Each block holds primitives of one kind; blocks are ordered by
/// kind, and pieces of one kind keep their order.
void append_blocks(const scenes::Scene& scene, std::span<const PrimitivePart> pieces,
                   LargePageVector<PrimitiveBlock>& blocks);

}  // namespace beambench::accel::bvh

#pragma once
// The data of the wide hierarchy in the form that streams of rays use.

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/vec3.hpp>

#include "accel/bvh/wide_bvh.hpp"
#include "accel/core/large_pages.hpp"

namespace beambench::accel::bvh {

/// The boxes of a node's children as centers and half sizes: the slab test then does not depend on
/// the signs of directions, so that rays of all octants share a list. Centers are relative to the
/// tree's center, and half sizes are widened by the error of float arithmetic
/// (stream_tests-inl.hpp).
struct alignas(64) StreamNode {
  std::array<std::array<float, kBvhLanes>, 3> center;  ///< x, y, z
  std::array<std::array<float, kBvhLanes>, 3> half;    ///< no ray meets missing children
  std::array<ChildReference, kBvhLanes> children;
  std::uint32_t count;
};
static_assert(sizeof(StreamNode) == 256);

/// A PrimitiveBlock in the form that streams test (stream_tests-inl.hpp). The numbers for triangles
/// are those of the canonical test in double, rounded once. Blocks of spheres and cones have only
/// the data that is not in lanes.
struct alignas(64) StreamBlock {
  std::array<std::array<float, kBvhLanes>, 3> a;       ///< x, y, z
  std::array<std::array<float, kBvhLanes>, 3> from_c;  ///< a - c
  std::array<std::array<float, kBvhLanes>, 3> to_b;    ///< b - a
  std::array<std::array<float, kBvhLanes>, 3> normal;  ///< (b - a) x (c - a)
  std::array<float, kBvhLanes> size;                   ///< M
  scenes::PrimitiveKind kind;
  std::uint32_t count;
  std::uint32_t first;  ///< number of the block's first triangle
  float leaf_extent;
};
static_assert(sizeof(StreamBlock) == 448);

/// A triangle for the canonical test, in one or two cache lines. All zero for other primitives.
struct alignas(16) WholeTriangle {
  glm::vec3 a;
  scenes::PrimitiveId polygon;
  glm::vec3 b;
  float unused_b;
  glm::vec3 c;
  float unused_c;
};
static_assert(sizeof(WholeTriangle) == 48);

/// The nodes and the triangles of a WideBvh, with its numbers.
struct StreamTree {
  glm::vec3 center{0.0F};    ///< the scene's center
  float center_size = 0.0F;  ///< the largest component of the center
  float half_size = 0.0F;    ///< along each axis, no place in a box is farther from the center
  LargePageVector<StreamNode> nodes;
  LargePageVector<StreamBlock> blocks;
  LargePageVector<WholeTriangle> triangles;  ///< the triangles of all blocks

  std::size_t bytes() const {
    return nodes.capacity() * sizeof(StreamNode) + blocks.capacity() * sizeof(StreamBlock) +
           triangles.capacity() * sizeof(WholeTriangle);
  }
};

/// Builds the tree. `parallel`: use all cores; the result is the same. `memory`: a tree whose
/// arrays are reused.
StreamTree build_stream_tree(const WideBvh& bvh, bool parallel, StreamTree memory = {});

}  // namespace beambench::accel::bvh

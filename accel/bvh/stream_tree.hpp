#pragma once
// What streams of rays need of the wide hierarchy in a form of their own.

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/vec3.hpp>

#include "accel/bvh/wide_bvh.hpp"
#include "accel/core/large_pages.hpp"

namespace beambench::accel::bvh {

/// The boxes of a node's children as centers and halves of their sizes: the slab test then needs no
/// sign of a direction, so that rays of all octants share a list. Centers are relative to that of
/// the tree, and halves widened by what float arithmetic may lose (stream_tests-inl.hpp).
struct alignas(64) StreamNode {
  std::array<std::array<float, kBvhLanes>, 3> center;  ///< x, y, z
  std::array<std::array<float, kBvhLanes>, 3> half;    ///< of missing children: no ray meets them
  std::array<ChildReference, kBvhLanes> children;
  std::uint32_t count;
};
static_assert(sizeof(StreamNode) == 256);

/// The normals of a block's triangles (b - a) x (c - a), and the sums of the sizes of their
/// components: as the canonical test computes them in double, rounded once.
struct alignas(64) BlockNormals {
  std::array<std::array<float, kBvhLanes>, 4> rows;  ///< x, y, z, sum
};
static_assert(sizeof(BlockNormals) == 128);

/// The nodes and the triangles' normals of a WideBvh, with its numbers.
struct StreamTree {
  glm::vec3 center{0.0F};  ///< of the scene
  float half_size = 0.0F;  ///< at least the distance of any place in a box from it, along each axis
  LargePageVector<StreamNode> nodes;
  LargePageVector<BlockNormals> normals;

  std::size_t bytes() const {
    return nodes.capacity() * sizeof(StreamNode) + normals.capacity() * sizeof(BlockNormals);
  }
};

/// `parallel`: on all cores; the result is the same.
StreamTree build_stream_tree(const WideBvh& bvh, bool parallel);

}  // namespace beambench::accel::bvh

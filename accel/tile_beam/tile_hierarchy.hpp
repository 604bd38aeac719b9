#pragma once
// The hierarchy traversed by tile beams: sixteen children per node, leaves of one kind each.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "accel/bvh/stream_tree.hpp"
#include "accel/bvh/wide_bvh.hpp"
#include "accel/core/expected_visits.hpp"
#include "accel/core/large_pages.hpp"
#include "accel/tile_beam/solids.hpp"
#include "scenes/bounds.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::tile_beam {

/// The number of children of a node, and of spheres or cones in a block.
inline constexpr std::size_t kTileLanes = 16;

/// The kind and place of a node's child.
class TileChild {
 public:
  enum class Kind : std::uint32_t { kNode, kMeshlet, kSpheres, kCones };
  static constexpr std::uint32_t kIndices = 1U << 30U;  ///< one more than the largest index

  TileChild() = default;
  TileChild(Kind kind, std::uint32_t index)
      : bits_(static_cast<std::uint32_t>(kind) << 30U | index) {}
  static TileChild from_bits(std::uint32_t bits) {
    TileChild child;
    child.bits_ = bits;
    return child;
  }

  Kind kind() const { return static_cast<Kind>(bits_ >> 30U); }
  std::uint32_t index() const { return bits_ & (kIndices - 1); }
  std::uint32_t bits() const { return bits_; }

 private:
  std::uint32_t bits_;  // uninitialized: stacks of hundreds are made for every tile
};

/// Up to sixteen boxes: lower x, y, z; upper x, y, z.
struct alignas(64) TileBoxes {
  std::array<std::array<float, kTileLanes>, 6> planes;

  void set(std::size_t lane, const scenes::Bounds& box) {
    for (int axis = 0; axis < 3; ++axis) {
      planes[static_cast<std::size_t>(axis)][lane] = box.lower[axis];
      planes[static_cast<std::size_t>(axis) + 3][lane] = box.upper[axis];
    }
  }
  scenes::Bounds get(std::size_t lane) const {
    return {{planes[0][lane], planes[1][lane], planes[2][lane]},
            {planes[3][lane], planes[4][lane], planes[5][lane]}};
  }
};

/// The directions that the fronts of children's triangles face: for each child, a cone around all
/// normals.
struct alignas(64) TileCones {
  std::array<std::array<float, kTileLanes>, 3> axis;
  std::array<float, kTileLanes> sine_squared;  ///< of half the cone's angle, rounded up

  void set(std::size_t lane, const glm::dvec3& along, double half_angle);
};

struct alignas(64) TileNode {
  TileBoxes boxes;
  TileCones cones;
  std::array<TileChild, kTileLanes> children;
  std::array<std::uint32_t, kTileLanes> leaves;  ///< of each child, including itself
  std::uint32_t count;
  std::uint32_t cone_lanes;  ///< bit i: child i has a cone and only triangles of solids
};

/// A few neighboring triangles and their shared corners: each corner is projected once.
struct alignas(64) Meshlet {
  static constexpr std::size_t kMaxVertices = 32;
  static constexpr std::size_t kMaxTriangles = 32;

  std::array<std::array<float, kMaxVertices>, 3> vertices;         ///< x, y, z
  std::array<std::array<std::uint8_t, kMaxTriangles>, 3> corners;  ///< of triangles, into vertices
  std::array<scenes::PrimitiveId, kMaxTriangles>
      primitives;  ///< the polygons that the triangles belong to
  std::uint32_t vertex_count;
  std::uint32_t triangle_count;
  float extent;             ///< longest side of the meshlet's box
  std::uint32_t solid;      ///< bit i: triangle i is part of a `Solid`
  std::uint32_t clockwise;  ///< bit i: its corners are clockwise, seen from outside

  glm::vec3 corner(std::size_t which, std::size_t triangle) const {
    const std::size_t vertex = corners[which][triangle];
    return {vertices[0][vertex], vertices[1][vertex], vertices[2][vertex]};
  }
};

struct alignas(64) SphereBlock {
  std::array<std::array<float, kTileLanes>, 3> center;
  std::array<float, kTileLanes> radius;
  std::array<scenes::PrimitiveId, kTileLanes> primitives;
  std::uint32_t inside_only;  ///< bit i: sphere i is seen only from inside
  std::uint32_t count;
};

struct alignas(64) ConeBlock {
  TileBoxes boxes;
  std::array<scenes::PrimitiveId, kTileLanes> primitives;
  std::uint32_t count;
};

/// The scene's vertices at the corners of a meshlet.
using MeshletVertices = std::array<std::uint32_t, Meshlet::kMaxVertices>;

/// The contents of leaves.
struct TileBlocks {
  LargePageVector<Meshlet> meshlets;
  LargePageVector<MeshletVertices> meshlet_vertices;  ///< if the scene moves; else empty
  LargePageVector<SphereBlock> spheres;
  LargePageVector<ConeBlock> cones;

  std::size_t count() const { return meshlets.size() + spheres.size() + cones.size(); }
};

/// A meshlet with triangles of a solid.
struct SolidMeshlet {
  std::uint32_t solid;
  std::uint32_t meshlet;

  friend auto operator<=>(const SolidMeshlet&, const SolidMeshlet&) = default;
};

/// A hierarchy over a scene's triangles, spheres and cones. Boxes are widened by
/// `overlap_tolerance`.
struct TileHierarchy : TileBlocks {
  LargePageVector<TileNode> nodes;  ///< children after their parents
  TileChild root{};
  Solids solids;                             ///< solids whose backs are culled; may be empty
  std::vector<SolidMeshlet> solid_meshlets;  ///< ascending
  scenes::Bounds bounds;                     ///< of everything, widened
  bool interleaves_rays = false;             ///< large enough to interleave single rays
  std::uint32_t depth = 0;                   ///< nodes on the longest path to a leaf, with the leaf
  std::uint64_t references = 0;
  ExpectedVisits visits;
  double cost = 0.0;      ///< the cost of the underlying binary hierarchy: see sah_cost
  bool is_refit = false;  ///< `visits` and `cost` are those of the original boxes
  /// The same binary hierarchy in the form for streams, with leaves of a few parts. It has nodes of
  /// its own only if the scene moves; otherwise those of `stream_tree` are used. Empty if lists are
  /// traced ray by ray.
  bvh::WideBvh stream_bvh;
  bvh::StreamTree stream_tree;

  bool empty() const { return references == 0; }
  std::size_t leaves() const { return count(); }
  /// Returns the bytes of nodes and leaves. Reserved memory beyond them was never touched.
  std::size_t bytes() const {
    return nodes.size() * sizeof(TileNode) + meshlets.size() * sizeof(Meshlet) +
           meshlet_vertices.size() * sizeof(MeshletVertices) +
           spheres.size() * sizeof(SphereBlock) + cones.size() * sizeof(ConeBlock);
  }
  /// Returns the bytes used only for streams.
  std::size_t stream_bytes() const {
    return stream_bvh.nodes.capacity() * sizeof(bvh::WideNode) +
           stream_bvh.blocks.capacity() * sizeof(bvh::PrimitiveBlock) + stream_tree.bytes();
  }
};

/// The maximum number of nodes from the root to a leaf: the maximum depth of the binary hierarchy,
/// plus one for a leaf that needs several blocks.
inline constexpr std::size_t kMaxTileDepth = 97;

struct TileHierarchyOptions {
  std::uint32_t max_leaf = 32;    ///< maximum number of primitives in a leaf
  bool parallel = false;          ///< build, and trace images, on all cores
  bool backface_culling = false;  ///< cull the invisible backs of solids in images
  bool streams = true;            ///< trace lists of rays as streams (accel/bvh/streams.hpp)
  bool moves = false;  ///< the scene's coordinates will change (tile_refit.hpp); no culling then
};

/// Returns the bounds of a node or leaf; a node's bounds follow from the boxes of its children.
scenes::Bounds bounds_of(const TileHierarchy& hierarchy, TileChild child);

/// Throws InputError if the scene needs more than TileChild::kIndices leaves of a kind.
TileHierarchy build_tile_hierarchy(const scenes::Scene& scene, const TileHierarchyOptions& options);

}  // namespace beambench::accel::tile_beam

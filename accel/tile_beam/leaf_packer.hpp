#pragma once
// Packs leaves of primitives into the blocks that SIMD processes: meshlets, spheres, cones.

#include <cstdint>
#include <span>
#include <vector>

#include "accel/bvh/bvh_builder.hpp"
#include "accel/tile_beam/tile_hierarchy.hpp"

namespace beambench::accel::tile_beam {

/// A piece in a leaf: a triangle of a polygon, or a whole sphere or cone.
struct TilePiece {
  scenes::PrimitiveId primitive;
  std::uint32_t index;  ///< into the scene's triangles, spheres or cones
  scenes::PrimitiveKind kind;
};

/// A block made of some of a leaf's pieces.
struct PackedLeaf {
  TileChild child;
  scenes::Bounds box;  ///< of its pieces' boxes
};

/// The blocks of several leaves.
struct PackedLeaves {
  TileBlocks blocks;
  std::vector<SolidMeshlet> solid_meshlets;
  std::vector<PackedLeaf> packed;    ///< leaf by leaf
  std::vector<std::uint32_t> first;  ///< of each leaf, in `packed`; one more for the end

  std::span<const PackedLeaf> of(std::size_t leaf) const {
    return std::span(packed).subspan(first[leaf], first[leaf + 1] - first[leaf]);
  }
};

/// The pieces of a scene, their boxes, and the solids that triangles form.
struct TilePieces {
  const scenes::Scene& scene;
  const Solids& solids;
  std::span<const TilePiece> pieces;
  std::span<const scenes::Bounds> boxes;
};

/// Packs leaves, each given by its items. A leaf becomes a block for each kind of primitive in it,
/// or several if one is full: at most kTileLanes for a leaf of up to 32 pieces. `parallel`: on all
/// cores; the blocks are the same. Throws InputError when there are more than TileChild::kIndices
/// blocks of a kind.
PackedLeaves pack_leaves(const TilePieces& pieces,
                         std::span<const std::span<const std::uint32_t>> leaves, bool parallel);

}  // namespace beambench::accel::tile_beam

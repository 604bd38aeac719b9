#pragma once
// Packs leaves of primitives into blocks for SIMD: meshlets, spheres, cones.

#include <cstdint>
#include <span>
#include <vector>

#include "accel/bvh/primitive_part.hpp"
#include "accel/tile_beam/tile_hierarchy.hpp"

namespace beambench::accel::tile_beam {

/// A block made of some of a leaf's parts.
struct PackedLeaf {
  TileChild child;
  scenes::Bounds box;  ///< of its parts' boxes
};

/// The blocks of several leaves.
struct PackedLeaves {
  TileBlocks blocks;
  std::vector<SolidMeshlet> solid_meshlets;
  std::vector<PackedLeaf> packed;    ///< leaf by leaf
  std::vector<std::uint32_t> first;  ///< index of each leaf in `packed`, plus one for the end

  std::span<const PackedLeaf> of(std::size_t leaf) const {
    return std::span(packed).subspan(first[leaf], first[leaf + 1] - first[leaf]);
  }
};

/// The parts of a scene's primitives, their boxes, and the solids that triangles form.
struct TileParts {
  const scenes::Scene& scene;
  const Solids& solids;
  std::span<const bvh::PrimitivePart> parts;
  std::span<const scenes::Bounds> boxes;
  bool moves;  ///< corners that coincide now may separate, so only those of one vertex are shared
};

/// Packs leaves, each given by its items. A leaf becomes a block for each kind of primitive in it,
/// or several if one is full: at most kTileLanes for a leaf of up to 32 parts. `parallel`: use all
/// cores; the blocks are the same. Throws InputError if there are more than TileChild::kIndices
/// blocks of a kind.
PackedLeaves pack_leaves(const TileParts& parts,
                         std::span<const std::span<const std::uint32_t>> leaves, bool parallel);

}  // namespace beambench::accel::tile_beam

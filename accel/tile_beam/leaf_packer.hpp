#pragma once
// From a leaf's primitives to the blocks that SIMD takes: meshlets, spheres, cones.

#include <cstdint>
#include <span>
#include <vector>

#include "accel/tile_beam/tile_hierarchy.hpp"

namespace beambench {

/// What a leaf refers to: a triangle of a polygon, or a whole sphere or cone.
struct TilePiece {
  PrimitiveId primitive;
  std::uint32_t index;  ///< into the scene's triangles, spheres or cones
};

/// A block made of some of a leaf's pieces.
struct PackedLeaf {
  TileChild child;
  Bounds box;  ///< of its pieces' boxes
};

/// Packs leaves into a hierarchy's blocks.
class LeafPacker {
 public:
  LeafPacker(const Scene& scene, std::span<const TilePiece> pieces, std::span<const Bounds> boxes,
             TileHierarchy& into)
      : scene_(&scene), pieces_(pieces), boxes_(boxes), into_(&into) {}

  /// The blocks of a leaf: one for each kind of primitive in it, more where one is full. At most
  /// kTileLanes for a leaf of no more than 32 pieces.
  std::span<const PackedLeaf> pack(std::span<const std::uint32_t> items);

 private:
  void add_triangle(std::uint32_t item);
  void add_sphere(std::uint32_t item);
  void add_cone(std::uint32_t item);
  PackedLeaf& begin(TileChild::Kind kind, std::size_t index);

  const Scene* scene_;
  std::span<const TilePiece> pieces_;
  std::span<const Bounds> boxes_;
  TileHierarchy* into_;
  std::vector<PackedLeaf> packed_;
};

}  // namespace beambench

#pragma once
// A part of a pencil as seen from its apex: the memory of a walk.

#include <array>
#include <cstddef>
#include <cstdint>

#include "scenes/primitive.hpp"

namespace beambench::accel::tile_beam {

/// One side of a cube around the apex, aligned with the world's axes: a ray belongs to the side
/// that its line crosses. In the side's coordinates (x, y, z), from the apex and with z through the
/// side, a point has the place u = x/z, v = y/z on it and w = 1/z; |u|, |v| <= 1.
struct CubeSide {
  static constexpr int kCount = 6;

  int number = 4;

  std::size_t z_axis() const { return static_cast<std::size_t>(number) / 2; }
  std::size_t x_axis() const { return (z_axis() + 1) % 3; }
  std::size_t y_axis() const { return (z_axis() + 2) % 3; }
  float sign() const { return number % 2 == 0 ? 1.0F : -1.0F; }  ///< of z along its axis
};

/// Up to 256 blocks of up to sixteen rays. They hold the rays of one side of the cube at a time. A
/// block's rays are in the order of the batch (by 4 x 4 pixels, if known), or were regrouped
/// because their neighbors in the batch are far apart. Sixteen blocks form a group.
struct PencilUnit {
  static constexpr std::size_t kBlock = 16;
  static constexpr std::size_t kListed = 256;  ///< blocks in the order of the batch
  static constexpr std::size_t kRays = kListed * kBlock;
  static constexpr std::size_t kBlocks = 2 * kListed;
  /// One block more than `kListed` may be occupied, because the last regrouped block may not be
  /// full.
  static constexpr std::size_t kPlaces = kListed + kBlock;
  static constexpr std::size_t kGroups = 32;  ///< 17 are used; the others fill registers

  template <class T, std::size_t n>
  using Array = std::array<T, n>;

  Array<std::uint16_t, kListed + 1> first;  ///< first ray of each listed block, and the end
  std::size_t listed;

  /// Returns the ray of a place in the arrays below.
  std::size_t ray_at(std::size_t at) const {
    return at < kRays ? first[at / kBlock] + at % kBlock : source[at - kRays];
  }

  /// The places of the rays, block by block; NaN in lanes without a ray of this side.
  alignas(64) Array<float, kBlocks * kBlock> u;
  alignas(64) Array<float, kBlocks * kBlock> v;
  /// The w that hits of a ray must exceed: the w of its origin if the apex is at its end, or of the
  /// nearest hit so far (initially 0) if the apex is behind its origin.
  alignas(64) Array<float, kBlocks * kBlock> w;
  alignas(64) Array<float, kBlocks * kBlock> origin_w;  ///< closest hits: w of the ray's origin
  alignas(
      64) Array<scenes::PrimitiveId, kBlocks * kBlock> primitive;  ///< of the nearest hit so far
  Array<std::uint16_t, kRays> source;                              ///< rays of newly formed blocks
  alignas(64) Array<std::uint16_t, kBlocks> lanes;  ///< lanes that hold a ray of this side

  /// Bounds of blocks.
  struct Bounds {
    alignas(64) Array<float, kBlocks> low_u, high_u, low_v, high_v, least_w, most_origin_w;
  };
  Bounds block;

  /// The blocks, ordered so that neighbors are close together; `slot` is a block's number. Lower
  /// ends are negated, so that a bounds test is a test of the sign.
  alignas(64) Array<std::uint32_t, kPlaces> slot;
  alignas(64) Array<std::uint16_t, kPlaces> alive;  ///< lanes that may still be hit
  alignas(64) Array<float, kPlaces> minus_low_u, high_u, minus_low_v, high_v, minus_w, origin_w_top;
  alignas(64) Array<float, kPlaces> middle_u, middle_v, half_u, half_v;
  /// For a bundle: the apexes hidden from each ray's origin, a bit each, by place.
  alignas(64) Array<std::uint16_t, kPlaces * kBlock> hidden;
  Array<std::uint8_t, kPlaces * kBlock> tests;  ///< triangles tested for all apexes, likewise
  std::size_t places;
  CubeSide side;  ///< the side that saw the last rays
  /// The distance from the apex, along the side's axis, of the nearest end of a ray toward the
  /// apex.
  float end_depth;
  float least_depth;  ///< of the origins, for a bundle

  /// The groups' bounds; those of a group without a live ray are empty.
  alignas(64) Array<float, kGroups> group_low_u, group_high_u, group_low_v, group_high_v, group_w,
      group_origin_w;
  alignas(64) Array<float, kGroups> group_rays, group_area;  ///< initial values
  Array<std::uint16_t, kGroups> group_blocks;                ///< alive, a bit each
  std::uint32_t groups_alive;
  std::size_t groups;
};

}  // namespace beambench::accel::tile_beam

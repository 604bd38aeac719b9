#pragma once
// A part of a pencil as its apex sees it: the memory of a walk.

#include <array>
#include <cstddef>
#include <cstdint>

#include "scenes/primitive.hpp"

namespace beambench::accel::tile_beam {

/// One side of a cube about the apex whose axes are the world's: a ray belongs to the side that its
/// line passes. In the side's coordinates (x, y, z), from the apex and with z through the side, a
/// point has the place u = x/z, v = y/z on it and w = 1/z; |u|, |v| <= 1.
struct CubeSide {
  static constexpr int kCount = 6;

  int number = 4;

  std::size_t z_axis() const { return static_cast<std::size_t>(number) / 2; }
  std::size_t x_axis() const { return (z_axis() + 1) % 3; }
  std::size_t y_axis() const { return (z_axis() + 2) % 3; }
  float sign() const { return number % 2 == 0 ? 1.0F : -1.0F; }  ///< of z along its axis
};

/// Up to 256 blocks of up to sixteen rays. Those of one side of the cube at a time; a block has
/// its rays in the order of the batch, of 4 x 4 pixels where these are known, or was put together
/// anew from rays whose neighbors in the batch lie far apart. Sixteen blocks are a group.
struct PencilUnit {
  static constexpr std::size_t kBlock = 16;
  static constexpr std::size_t kListed = 256;  ///< blocks in the order of the batch
  static constexpr std::size_t kRays = kListed * kBlock;
  static constexpr std::size_t kBlocks = 2 * kListed;
  /// A block more than `kListed` may be occupied: the last that was put together anew is not full.
  static constexpr std::size_t kPlaces = kListed + kBlock;
  static constexpr std::size_t kGroups = 32;  ///< 17, for registers

  template <class T, std::size_t n>
  using Array = std::array<T, n>;

  Array<std::uint16_t, kListed + 1> first;  ///< ray of each listed block, and behind the last
  std::size_t listed;

  /// The ray of a place in the arrays below.
  std::size_t ray_at(std::size_t at) const {
    return at < kRays ? first[at / kBlock] + at % kBlock : source[at - kRays];
  }

  /// Of each ray, by block. NaN where a lane holds no ray of this side.
  alignas(64) Array<float, kBlocks * kBlock> u;
  alignas(64) Array<float, kBlocks * kBlock> v;
  /// What hits a ray must have a larger w: its own point's where the apex is at its end; the
  /// nearest hit's so far where the apex is behind its origin, at first 0.
  alignas(64) Array<float, kBlocks * kBlock> w;
  alignas(64) Array<float, kBlocks * kBlock> origin_w;  ///< closest hits: w of the ray's origin
  alignas(
      64) Array<scenes::PrimitiveId, kBlocks * kBlock> primitive;  ///< of the nearest hit so far
  Array<std::uint16_t, kRays> source;               ///< rays of blocks that were put together anew
  alignas(64) Array<std::uint16_t, kBlocks> lanes;  ///< that hold a ray of this side

  /// Bounds of blocks.
  struct Bounds {
    alignas(64) Array<float, kBlocks> low_u, high_u, low_v, high_v, least_w, most_origin_w;
  };
  Bounds block;

  /// The blocks in an order in which neighbors lie close together: `slot` is a block's number.
  /// Lower ends are negated, so that a test of bounds is a sign.
  alignas(64) Array<std::uint32_t, kPlaces> slot;
  alignas(64) Array<std::uint16_t, kPlaces> alive;  ///< lanes that may still be hit
  alignas(64) Array<float, kPlaces> minus_low_u, high_u, minus_low_v, high_v, minus_w, origin_w_top;
  alignas(64) Array<float, kPlaces> middle_u, middle_v, half_u, half_v;
  std::size_t places;
  CubeSide side;  ///< that saw the last rays
  /// Rays toward the apex: how far from it along the side's axis the first of them ends.
  float end_depth;

  /// The groups' bounds; a group without a ray alive has none.
  alignas(64) Array<float, kGroups> group_low_u, group_high_u, group_low_v, group_high_v, group_w,
      group_origin_w;
  alignas(64) Array<float, kGroups> group_rays, group_area;  ///< as they were at first
  Array<std::uint16_t, kGroups> group_blocks;                ///< alive, a bit each
  std::uint32_t groups_alive;
  std::size_t groups;
};

}  // namespace beambench::accel::tile_beam

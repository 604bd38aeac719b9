#pragma once
// The image of a tile: the nearest hit so far of each of its samples.

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "accel/tile_beam/tile_view.hpp"
#include "scenes/primitive.hpp"

namespace beambench::accel::tile_beam {

/// Samples are in blocks of 4 x 4, which fill a 512-bit register; blocks are in rows. For a hit,
/// 1/t is stored, which is linear on the screen for points of a plane; 0 is the background, and
/// infinity a hit at t = 0. Samples beyond the raster's ends hold infinity, so nothing is nearer.
struct TileImage {
  static constexpr int kBlockColumns = kTileWidth / 4;
  static constexpr int kBlockRows = kTileHeight / 4;
  static constexpr std::size_t kBlockSamples = 16;
  /// The tile's width is 2 to this power: place(x, y) for the first sample of a block is (y <<
  /// kWidthBits) + 4 x.
  static constexpr int kWidthBits = std::countr_zero(static_cast<unsigned>(kTileWidth));
  static_assert(kTileWidth == 1 << kWidthBits);
  static constexpr std::size_t kSamples = std::size_t{kTileWidth} * kTileHeight;
  /// Hierarchical Z has one level, of cells of 8 x 8 samples.
  static constexpr int kHzColumns = kTileWidth / 8;
  static constexpr int kHzRows = kTileHeight / 8;

  static constexpr std::size_t block(int column, int row) {
    const int number = row * kBlockColumns + column;
    return static_cast<std::size_t>(number) * kBlockSamples;
  }
  static constexpr std::size_t place(int x, int y) {
    return block(x >> 2, y >> 2) + static_cast<std::size_t>((y & 3) * 4 + (x & 3));
  }

  alignas(64) std::array<float, kSamples> inverse_t;
  alignas(64) std::array<scenes::PrimitiveId, kSamples> primitive;  ///< not set where 1/t is 0
  /// The smallest 1/t of a cell, valid unless `stale` marks the cell.
  std::array<float, std::size_t{kHzColumns} * kHzRows> farthest;
  std::array<std::uint32_t, kHzRows> stale;  ///< one bit per cell of a row
  bool touched;                              ///< false: all background, not cleared yet
};

/// The 1/t of anything at the eye or behind it: nearer than everything else.
inline constexpr float kNearestOfAll = 1e30F;

/// Returns the stored value of a hit. t may be -0, which is as near as 0.
inline float inverse_of(float t) { return 1.0F / std::abs(t); }

/// Samples [left, right] x [top, bottom] of a tile.
struct SampleRectangle {
  std::uint8_t left;
  std::uint8_t right;
  std::uint8_t top;
  std::uint8_t bottom;

  int count() const { return (right - left + 1) * (bottom - top + 1); }
};

}  // namespace beambench::accel::tile_beam

// The tile's image under SIMD: clearing, coarse depths, blocks of samples.

#if defined(ACCEL_TILE_BEAM_TILE_RASTER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_TILE_RASTER_INL
#undef ACCEL_TILE_BEAM_TILE_RASTER_INL
#else
#define ACCEL_TILE_BEAM_TILE_RASTER_INL
#endif

#include <algorithm>
#include <limits>

#include "accel/tile_beam/lanes-inl.hpp"
#include "accel/tile_beam/tile_image.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::HWY_NAMESPACE {

/// The samples' places in a block, for the register that begins with sample `first` of it.
HWY_INLINE Floats block_x(std::size_t first) {
  const auto index = hn::Add(hn::Iota(IntTag(), 0), hn::Set(IntTag(), static_cast<int>(first)));
  return hn::ConvertTo(Tag(), hn::And(index, hn::Set(IntTag(), 3)));
}
HWY_INLINE Floats block_y(std::size_t first) {
  const auto index = hn::Add(hn::Iota(IntTag(), 0), hn::Set(IntTag(), static_cast<int>(first)));
  return hn::ConvertTo(Tag(), hn::ShiftRight<2>(index));
}

/// Keeps hits where they are nearer than what a block holds: those with `inverse_t` in the lanes of
/// `hit`, from place `at` on. Of primitives at the very same place the first drawn stays: to look
/// for the lowest id would cost 5% of a trace, and rounding decides between most of them anyway.
HWY_INLINE void keep_nearer(TileImage& image, std::size_t at, Floats inverse_t, Mask hit,
                            PrimitiveId primitive) {
  float* const depths = image.inverse_t.data() + at;
  const Mask nearer = hn::And(hit, hn::Gt(inverse_t, load(depths)));
  hn::BlendedStore(inverse_t, nearer, Tag(), depths);
  const hn::RebindToUnsigned<Tag> ids;
  hn::BlendedStore(hn::Set(ids, primitive), hn::RebindMask(ids, nearer), ids,
                   image.primitive.data() + at);
}

inline void clear(TileImage& image, const TileView& view) {
  std::fill(image.inverse_t.begin(), image.inverse_t.end(), 0.0F);
  std::fill(image.primitive.begin(), image.primitive.end(), kNoPrimitive);
  std::fill(image.farthest.begin(), image.farthest.end(), 0.0F);
  image.stale.fill(0);
  image.touched = true;
  if (view.width == kTileWidth && view.height == kTileHeight) return;
  for (int y = 0; y < kTileHeight; ++y) {
    for (int x = y < view.height ? view.width : 0; x < kTileWidth; ++x) {
      image.inverse_t[TileImage::place(x, y)] = std::numeric_limits<float>::infinity();
    }
  }
}

/// Says that samples within a rectangle may have become nearer.
HWY_INLINE void mark_stale(TileImage& image, const SampleRectangle& where) {
  const std::uint32_t columns = (2U << (where.right >> 3U)) - (1U << (where.left >> 3U));
  for (unsigned row = where.top >> 3U; row <= where.bottom >> 3U; ++row)
    image.stale[row] |= columns;
}

/// The smallest 1/t of a square of 8 x 8 samples.
HWY_INLINE float farthest_of(TileImage& image, unsigned column, unsigned row) {
  float& farthest =
      image.farthest[std::size_t{row} * TileImage::kSquareColumns + std::size_t{column}];
  if ((image.stale[row] >> column & 1U) != 0) {
    image.stale[row] &= ~(1U << column);
    const float* block = image.inverse_t.data() +
                         TileImage::block(static_cast<int>(2 * column), static_cast<int>(2 * row));
    Floats smallest = all(std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < 32; i += kLanes) {
      smallest =
          hn::Min(smallest, hn::Min(load(block + i), load(block + TileImage::block(0, 1) + i)));
    }
    farthest = hn::GetLane(hn::MinOfLanes(Tag(), smallest));
  }
  return farthest;
}

/// Is all in a rectangle nearer than something whose 1/t is at most `inverse_t`? May say no where
/// it is, but never yes where it is not.
inline bool hides(TileImage& image, const SampleRectangle& where, float inverse_t) {
  const unsigned left = where.left >> 3U;
  const unsigned right = where.right >> 3U;
  const unsigned top = where.top >> 3U;
  const unsigned bottom = where.bottom >> 3U;
  if ((right - left + 1) * (bottom - top + 1) > 12)
    return false;  // looking costs more than it gains
  for (unsigned row = top; row <= bottom; ++row) {
    for (unsigned column = left; column <= right; ++column) {
      if (farthest_of(image, column, row) < inverse_t) return false;
    }
  }
  return true;
}

/// The smallest 1/t of all of the tile.
inline float farthest_of_all(TileImage& image) {
  float smallest = std::numeric_limits<float>::infinity();
  for (unsigned row = 0; row < TileImage::kSquareRows; ++row) {
    for (unsigned column = 0; column < TileImage::kSquareColumns; ++column) {
      smallest = std::min(smallest, farthest_of(image, column, row));
      if (smallest == 0.0F) return smallest;
    }
  }
  return smallest;
}

}  // namespace beambench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

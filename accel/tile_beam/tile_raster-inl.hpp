// SIMD operations on a tile's image: clearing, hierarchical Z, blocks of samples.

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
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Returns the samples' places in a block, for the register that begins with sample `first`.
HWY_INLINE Floats block_x(std::size_t first) {
  const auto index = hn::Add(hn::Iota(IntTag(), 0), hn::Set(IntTag(), static_cast<int>(first)));
  return hn::ConvertTo(Tag(), hn::And(index, hn::Set(IntTag(), 3)));
}
HWY_INLINE Floats block_y(std::size_t first) {
  const auto index = hn::Add(hn::Iota(IntTag(), 0), hn::Set(IntTag(), static_cast<int>(first)));
  return hn::ConvertTo(Tag(), hn::ShiftRight<2>(index));
}

/// Keeps hits that are nearer than the contents of a block: those with `inverse_t` in the lanes of
/// `hit`, from place `at` on. Of primitives at the same depth, the first one drawn is kept: finding
/// the lowest id would cost 5% of a trace, and rounding decides between most of them anyway.
HWY_INLINE void keep_nearer(TileImage& image, std::size_t at, Floats inverse_t, Mask hit,
                            scenes::PrimitiveId primitive) {
  float* const depths = image.inverse_t.data() + at;
  const Mask nearer = hn::And(hit, hn::Gt(inverse_t, load(depths)));
  hn::BlendedStore(inverse_t, nearer, Tag(), depths);
  const hn::RebindToUnsigned<Tag> ids;
  hn::BlendedStore(hn::Set(ids, primitive), hn::RebindMask(ids, nearer), ids,
                   image.primitive.data() + at);
}

inline void clear(TileImage& image, const TileView& view) {
  std::fill(image.inverse_t.begin(), image.inverse_t.end(), 0.0F);
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

/// Marks that samples within a rectangle may have become nearer.
HWY_INLINE void mark_stale(TileImage& image, const SampleRectangle& where) {
  const std::uint32_t columns = (2U << (where.right >> 3U)) - (1U << (where.left >> 3U));
  for (unsigned row = where.top >> 3U; row <= where.bottom >> 3U; ++row)
    image.stale[row] |= columns;
}

/// A cell of hierarchical Z: 8 x 8 samples of a tile.
class HzCell {
 public:
  HWY_INLINE HzCell(TileImage& image, unsigned column, unsigned row)
      : image_(&image), column_(column), row_(row) {}

  /// Returns the smallest 1/t.
  HWY_INLINE float farthest() const { return is_stale() ? found(smallest()) : kept(); }
  /// Returns whether the whole cell is at least as near as 1/t.
  HWY_INLINE bool hides(float inverse_t) const {
    if (!is_stale()) return kept() >= inverse_t;
    const Floats now = smallest();
    if (!hn::AllTrue(Tag(), hn::Ge(now, all(inverse_t)))) return false;
    found(now);
    return true;
  }

 private:
  HWY_INLINE bool is_stale() const { return (image_->stale[row_] >> column_ & 1U) != 0; }
  HWY_INLINE float& kept() const {
    return image_->farthest[std::size_t{row_} * TileImage::kHzColumns + std::size_t{column_}];
  }
  HWY_INLINE Floats smallest() const {
    const float* block = image_->inverse_t.data() + TileImage::block(static_cast<int>(2 * column_),
                                                                     static_cast<int>(2 * row_));
    Floats smallest = hn::Min(load(block), load(block + TileImage::block(0, 1)));
    for (std::size_t i = kLanes; i < 32; i += kLanes) {
      smallest =
          hn::Min(smallest, hn::Min(load(block + i), load(block + TileImage::block(0, 1) + i)));
    }
    return smallest;
  }
  HWY_INLINE float found(Floats smallest) const {
    image_->stale[row_] &= ~(1U << column_);
    return kept() = hn::GetLane(hn::MinOfLanes(Tag(), smallest));
  }

  TileImage* image_;
  unsigned column_;
  unsigned row_;
};

/// Returns whether everything in a rectangle is nearer than something whose 1/t is at most
/// `inverse_t`. Conservative: may return false even if it is hidden, but never true if it is not.
inline bool hides(TileImage& image, const SampleRectangle& where, float inverse_t) {
  const unsigned left = where.left >> 3U;
  const unsigned right = where.right >> 3U;
  const unsigned top = where.top >> 3U;
  const unsigned bottom = where.bottom >> 3U;
  constexpr unsigned kMaxCells = 40;  // testing more would cost more than it saves
  if ((right - left + 1) * (bottom - top + 1) > kMaxCells) return false;
  for (unsigned row = top; row <= bottom; ++row) {
    for (unsigned column = left; column <= right; ++column) {
      if (!HzCell(image, column, row).hides(inverse_t)) return false;
    }
  }
  return true;
}

/// Returns the smallest 1/t of the tile. `open` is the cell tested first; if there is background,
/// it is set to a cell with background, which most likely still has some next time.
inline float farthest_of_all(TileImage& image, unsigned& open) {
  constexpr unsigned kColumns = TileImage::kHzColumns;
  const auto farthest = [&](unsigned cell) {
    return HzCell(image, cell % kColumns, cell / kColumns).farthest();
  };
  float smallest = farthest(open);
  for (unsigned cell = 0; smallest > 0.0F && cell < image.farthest.size(); ++cell) {
    smallest = std::min(smallest, farthest(cell));
    open = cell;
  }
  return smallest;
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// Converts a tile's image to the hits of the samples' pixels.

#if defined(ACCEL_TILE_BEAM_RESOLVE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_RESOLVE_INL
#undef ACCEL_TILE_BEAM_RESOLVE_INL
#else
#define ACCEL_TILE_BEAM_RESOLVE_INL
#endif

#include <algorithm>

#include "accel/tile_beam/sample_raster.hpp"
#include "accel/tile_beam/tile_raster-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Images with at least this many samples exceed the caches and are written with streaming stores.
inline constexpr std::size_t kStreamedSamples = std::size_t{1} << 17U;

/// Returns whether the image's rows are whole cache lines and too many for the caches.
inline bool is_streamed(const HitSpan& buffer) {
  return buffer.samples() == 1 && buffer.width() % 16 == 0 && buffer.size() > kStreamedSamples;
}

/// Writes a row of sixteen values, a cache line.
template <bool kStreamed, class D, class T = hn::TFromD<D>>
HWY_INLINE void write(D d, hn::Vec<D> values, T* to) {
  if constexpr (kStreamed) {
    hn::Stream(values, d, to);
  } else {
    hn::StoreU(values, d, to);
  }
}

#if HWY_MAX_BYTES == 64  // a block fills a register
/// Converts four adjacent blocks of 4 x 4 samples to rows of sixteen, by transposing 4 x 4 quarters
/// of registers.
template <class D>
HWY_INLINE std::array<hn::Vec<D>, 4> rows_of(D d, const std::array<hn::Vec<D>, 4>& blocks) {
  const auto& [a, b, c, e] = blocks;
  const auto upper_ac = hn::ConcatLowerLower(d, c, a);  // a0 a1 c0 c1
  const auto upper_be = hn::ConcatLowerLower(d, e, b);
  const auto lower_ac = hn::ConcatUpperUpper(d, c, a);  // a2 a3 c2 c3
  const auto lower_be = hn::ConcatUpperUpper(d, e, b);
  return {hn::OddEvenBlocks(hn::SwapAdjacentBlocks(upper_be), upper_ac),
          hn::OddEvenBlocks(upper_be, hn::SwapAdjacentBlocks(upper_ac)),
          hn::OddEvenBlocks(hn::SwapAdjacentBlocks(lower_be), lower_ac),
          hn::OddEvenBlocks(lower_be, hn::SwapAdjacentBlocks(lower_ac))};
}
#endif

/// Writes `height` rows of values of four adjacent blocks. `of(d, place)` returns the values that
/// begin at a place in the image. `place_of_row(y)` is the destination of a row.
template <bool kStreamed, class T, class PlaceOfRow, class Values>
HWY_INLINE void write_blocks(std::size_t from, int height, PlaceOfRow place_of_row, T* to,
                             Values of) {
  constexpr std::size_t kBlock = TileImage::kBlockSamples;
#if HWY_MAX_BYTES == 64
  const hn::CappedTag<T, kBlock> d;
  const auto rows = rows_of<decltype(d)>(
      d, {of(d, from), of(d, from + kBlock), of(d, from + 2 * kBlock), of(d, from + 3 * kBlock)});
  for (int y = 0; y < height; ++y) {
    write<kStreamed>(d, rows[static_cast<std::size_t>(y)], to + place_of_row(y));
  }
#else
  const hn::CappedTag<T, 4> four;
  for (int y = 0; y < height; ++y) {
    for (std::size_t i = 0; i < kBlock; i += hn::Lanes(four)) {
      // Four consecutive samples are adjacent; the next are in another block.
      const std::size_t place =
          from + (i >> 2U) * kBlock + static_cast<std::size_t>(4 * y) + (i & 3U);
      write<kStreamed>(four, of(four, place), to + place_of_row(y) + i);
    }
  }
#endif
}

/// Writes four adjacent blocks.
template <bool kStreamed>
HWY_INLINE void resolve_four(const TileImage& image, int column, int row, const TileView& view,
                             const HitSpan& buffer) {
  const std::size_t from = TileImage::block(column, row);
  const int height = std::min(4, view.height - 4 * row);
  const auto place_of_row = [&](int y) {
    return buffer.index(view.left + 4 * column, view.top + 4 * row + y, 0);
  };
  write_blocks<kStreamed>(from, height, place_of_row, buffer.t(), [&](auto d, std::size_t place) {
    return reciprocal(d, hn::Load(d, &image.inverse_t[place]));
  });
  write_blocks<kStreamed>(
      from, height, place_of_row, buffer.primitive(), [&](auto d, std::size_t place) {
        const hn::Rebind<float, decltype(d)> depths;
        const auto is_hit = hn::Gt(hn::Load(depths, &image.inverse_t[place]), hn::Zero(depths));
        return hn::IfThenElse(hn::RebindMask(d, is_hit), hn::Load(d, &image.primitive[place]),
                              hn::Set(d, scenes::kNoPrimitive));
      });
}

/// Writes the samples of a tile from a column on, one by one.
inline void resolve_rest(const TileImage& image, const TileView& view, int first,
                         const HitSpan& buffer) {
  for (int y = 0; y < view.height; ++y) {
    for (int x = first; x < view.width; ++x) {
      const std::size_t to = buffer.index(view.left + x, view.top + y, 0);
      const std::size_t at = TileImage::place(x, y);
      buffer.t()[to] = 1.0F / image.inverse_t[at];
      buffer.primitive()[to] =
          image.inverse_t[at] > 0.0F ? image.primitive[at] : scenes::kNoPrimitive;
    }
  }
}

/// Writes a tile with one sample per pixel: rows of blocks are runs of the buffer.
template <bool kStreamed>
inline void resolve_blocks(const TileImage& image, const TileView& view, const HitSpan& buffer) {
  const int whole = view.width / 16 * 4;
  for (int row = 0; 4 * row < view.height; ++row) {
    for (int column = 0; column < whole; column += 4) {
      resolve_four<kStreamed>(image, column, row, view, buffer);
    }
  }
  resolve_rest(image, view, 4 * whole, buffer);
}

/// Writes background without tracing rays.
template <bool kStreamed>
inline void paint_background(const TileView& view, const HitSpan& buffer) {
  for (int y = 0; y < view.height; ++y) {
    const std::size_t to = buffer.index(view.left, view.top + y, 0);
    const auto width = static_cast<std::size_t>(view.width);
    std::size_t x = 0;
    const Tag d;
    const hn::RebindToUnsigned<Tag> ids;
    for (; x + kLanes <= width; x += kLanes) {
      write<kStreamed>(d, hn::Set(d, kInfinity), buffer.t() + to + x);
      write<kStreamed>(ids, hn::Set(ids, scenes::kNoPrimitive), buffer.primitive() + to + x);
    }
    std::fill_n(buffer.t() + to + x, width - x, kInfinity);
    std::fill_n(buffer.primitive() + to + x, width - x, scenes::kNoPrimitive);
  }
}

/// Writes a tile with several samples per pixel; a pixel's samples are adjacent in the buffer and
/// may be shared.
inline void resolve_samples(TileImage& image, const SampleRaster& raster, const TileView& view,
                            const HitSpan& buffer) {
  if (!image.touched) clear(image, view);
  float* const t = image.inverse_t.data();
  for (std::size_t i = 0; i < TileImage::kSamples; i += kLanes) {
    store(reciprocal(load(t + i)), t + i);
  }
  for (int y = 0; y < view.height; ++y) {
    for (const SampleRaster::Place& place : raster.places) {
      raster.for_each_of_row(place, buffer, view.left, view.top + y, view.width,
                             [&](int x, std::size_t index) {
                               const std::size_t at = TileImage::place(x, y);
                               buffer.t()[index] = t[at];
                               buffer.primitive()[index] =
                                   t[at] < kInfinity ? image.primitive[at] : scenes::kNoPrimitive;
                             });
    }
  }
}

template <bool kStreamed>
void resolve_pixels(const TileImage& image, const TileView& view, const HitSpan& buffer) {
  if (image.touched) {
    resolve_blocks<kStreamed>(image, view, buffer);
  } else {
    paint_background<kStreamed>(view, buffer);
  }
}

/// Writes the hits of a tile, which is not used afterward.
inline void resolve(TileImage& image, const SampleRaster& raster, const TileView& view,
                    const HitSpan& buffer) {
  if (buffer.samples() > 1) {
    resolve_samples(image, raster, view, buffer);
  } else if (is_streamed(buffer)) {
    resolve_pixels<true>(image, view, buffer);
  } else {
    resolve_pixels<false>(image, view, buffer);
  }
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

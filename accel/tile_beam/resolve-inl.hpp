// From a tile's image to the hits of the samples' pixels.

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
namespace beambench::HWY_NAMESPACE {

/// Images larger than this are written past the caches, which could not hold them.
inline constexpr std::size_t kStreamedSamples = std::size_t{1} << 17U;

/// Are the image's rows whole cache lines, and so many that they are better written past the
/// caches?
inline bool is_streamed(const HitBuffer& buffer) {
  return buffer.samples() == 1 && buffer.width() % 16 == 0 && buffer.size() > kStreamedSamples;
}

/// Writes sixteen values of a row, a cache line, four by four.
template <bool kStreamed, class T, class Load>
HWY_INLINE void write_line(T* to, Load load_four) {
  const hn::CappedTag<T, 4> four;
  for (std::size_t i = 0; i < 16; i += hn::Lanes(four)) {
    if constexpr (kStreamed) {
      hn::Stream(load_four(four, i), four, to + i);
    } else {
      hn::StoreU(load_four(four, i), four, to + i);
    }
  }
}

/// Writes four blocks that lie side by side.
template <bool kStreamed>
HWY_INLINE void resolve_four(const TileImage& image, int column, int row, const TileView& view,
                             HitBuffer& buffer) {
  const std::size_t from = TileImage::block(column, row);
  alignas(64) std::array<float, 4 * TileImage::kBlockSamples> t;
  for (std::size_t i = 0; i < t.size(); i += kLanes) {
    store(hn::Div(all(1.0F), load(&image.inverse_t[from + i])), &t[i]);
  }
  const int height = std::min(4, view.height - 4 * row);
  for (int y = 0; y < height; ++y) {
    const std::size_t to = buffer.index(view.left + 4 * column, view.top + 4 * row + y, 0);
    const auto place = [y](std::size_t i) {  // four samples lie together, the next in another block
      return (i >> 2U) * TileImage::kBlockSamples + static_cast<std::size_t>(4 * y) + (i & 3U);
    };
    write_line<kStreamed>(buffer.t() + to,
                          [&](auto d, std::size_t i) { return hn::Load(d, &t[place(i)]); });
    write_line<kStreamed>(buffer.primitive() + to, [&](auto d, std::size_t i) {
      return hn::Load(d, &image.primitive[from + place(i)]);
    });
  }
}

/// Writes the samples of a tile from a column on, one by one.
inline void resolve_rest(const TileImage& image, const TileView& view, int first,
                         HitBuffer& buffer) {
  for (int y = 0; y < view.height; ++y) {
    for (int x = first; x < view.width; ++x) {
      const std::size_t to = buffer.index(view.left + x, view.top + y, 0);
      buffer.t()[to] = 1.0F / image.inverse_t[TileImage::place(x, y)];
      buffer.primitive()[to] = image.primitive[TileImage::place(x, y)];
    }
  }
}

/// One sample a pixel: rows of blocks are runs of the buffer.
template <bool kStreamed>
inline void resolve_blocks(const TileImage& image, const TileView& view, HitBuffer& buffer) {
  const int whole = view.width / 16 * 4;
  for (int row = 0; 4 * row < view.height; ++row) {
    for (int column = 0; column < whole; column += 4) {
      resolve_four<kStreamed>(image, column, row, view, buffer);
    }
  }
  resolve_rest(image, view, 4 * whole, buffer);
}

/// Background, without a ray.
template <bool kStreamed>
inline void paint_background(const TileView& view, HitBuffer& buffer) {
  for (int y = 0; y < view.height; ++y) {
    const std::size_t to = buffer.index(view.left, view.top + y, 0);
    const auto width = static_cast<std::size_t>(view.width);
    std::size_t x = 0;
    for (; x + 16 <= width; x += 16) {
      write_line<kStreamed>(buffer.t() + to + x,
                            [](auto d, std::size_t) { return hn::Set(d, kInfinity); });
      write_line<kStreamed>(buffer.primitive() + to + x,
                            [](auto d, std::size_t) { return hn::Set(d, kNoPrimitive); });
    }
    std::fill_n(buffer.t() + to + x, width - x, kInfinity);
    std::fill_n(buffer.primitive() + to + x, width - x, kNoPrimitive);
  }
}

inline void resolve_each(const TileImage& image, const SampleRaster& raster, const TileView& view,
                         HitBuffer& buffer) {
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const std::size_t at = TileImage::place(x, y);
      const float t = image.touched ? 1.0F / image.inverse_t[at] : kInfinity;
      const PrimitiveId primitive = image.touched ? image.primitive[at] : kNoPrimitive;
      raster.for_each_index(buffer, view.left + x, view.top + y, [&](std::size_t index) {
        buffer.t()[index] = t;
        buffer.primitive()[index] = primitive;
      });
    }
  }
}

template <bool kStreamed>
void resolve_pixels(const TileImage& image, const TileView& view, HitBuffer& buffer) {
  if (image.touched) {
    resolve_blocks<kStreamed>(image, view, buffer);
  } else {
    paint_background<kStreamed>(view, buffer);
  }
}

inline void resolve(const TileImage& image, const SampleRaster& raster, const TileView& view,
                    HitBuffer& buffer) {
  if (buffer.samples() > 1) {
    resolve_each(image, raster, view, buffer);
  } else if (is_streamed(buffer)) {
    resolve_pixels<true>(image, view, buffer);
  } else {
    resolve_pixels<false>(image, view, buffer);
  }
}

}  // namespace beambench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

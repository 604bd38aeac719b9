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

/// Writes the four rows of a block, or as much of them as the tile holds.
HWY_INLINE void resolve_block(const TileImage& image, int column, int row, const TileView& view,
                              HitBuffer& buffer) {
  const hn::CappedTag<float, 4> four;
  const hn::RebindToUnsigned<decltype(four)> four_ids;
  const std::size_t block = TileImage::block(column, row);
  alignas(64) std::array<float, TileImage::kBlockSamples> t;
  for (std::size_t i = 0; i < t.size(); i += kLanes) {
    store(hn::Div(all(1.0F), load(&image.inverse_t[block + i])), &t[i]);
  }
  const int width = std::min(4, view.width - 4 * column);
  const int height = std::min(4, view.height - 4 * row);
  for (int y = 0; y < height; ++y) {
    const std::size_t to = buffer.index(view.left + 4 * column, view.top + 4 * row + y, 0);
    const auto from = static_cast<std::size_t>(4 * y);
    const PrimitiveId* const primitives = &image.primitive[block + from];
    if (width == 4) {
      for (std::size_t i = 0; i < 4; i += hn::Lanes(four)) {
        hn::StoreU(hn::Load(four, &t[from + i]), four, buffer.t() + to + i);
        hn::StoreU(hn::Load(four_ids, primitives + i), four_ids, buffer.primitive() + to + i);
      }
    } else {
      std::copy_n(&t[from], width, buffer.t() + to);
      std::copy_n(primitives, width, buffer.primitive() + to);
    }
  }
}

/// One sample a pixel: rows of blocks are runs of the buffer.
inline void resolve_blocks(const TileImage& image, const TileView& view, HitBuffer& buffer) {
  for (int row = 0; 4 * row < view.height; ++row) {
    for (int column = 0; 4 * column < view.width; ++column) {
      resolve_block(image, column, row, view, buffer);
    }
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

/// Background, without a ray.
inline void paint_background(const TileView& view, HitBuffer& buffer) {
  for (int y = 0; y < view.height; ++y) {
    const std::size_t to = buffer.index(view.left, view.top + y, 0);
    std::fill_n(buffer.t() + to, view.width, kInfinity);
    std::fill_n(buffer.primitive() + to, view.width, kNoPrimitive);
  }
}

inline void resolve(const TileImage& image, const SampleRaster& raster, const TileView& view,
                    HitBuffer& buffer) {
  if (buffer.samples() > 1) {
    resolve_each(image, raster, view, buffer);
  } else if (image.touched) {
    resolve_blocks(image, view, buffer);
  } else {
    paint_background(view, buffer);
  }
}

}  // namespace beambench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

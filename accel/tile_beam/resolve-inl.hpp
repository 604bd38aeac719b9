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

/// One sample a pixel: rows of the tile are runs of the buffer.
inline void resolve_rows(const TileImage& image, const TileView& view, HitBuffer& buffer) {
  alignas(64) std::array<float, kTileWidth> t;
  alignas(64) std::array<PrimitiveId, kTileWidth> primitive;
  for (int y = 0; y < view.height; ++y) {
    for (int column = 0; column < TileImage::kBlockColumns; ++column) {
      const std::size_t from = TileImage::place(4 * column, y);
      const hn::CappedTag<float, 4> four;
      const hn::RebindToUnsigned<decltype(four)> four_ids;
      const auto at = static_cast<std::size_t>(4 * column);
      for (std::size_t i = 0; i < 4; i += hn::Lanes(four)) {
        hn::Store(hn::Div(hn::Set(four, 1.0F), hn::Load(four, &image.inverse_t[from + i])), four,
                  &t[at + i]);
        hn::Store(hn::Load(four_ids, &image.primitive[from + i]), four_ids, &primitive[at + i]);
      }
    }
    const std::size_t to = buffer.index(view.left, view.top + y, 0);
    std::copy_n(t.data(), view.width, buffer.t() + to);
    std::copy_n(primitive.data(), view.width, buffer.primitive() + to);
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
    resolve_rows(image, view, buffer);
  } else {
    paint_background(view, buffer);
  }
}

}  // namespace beambench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

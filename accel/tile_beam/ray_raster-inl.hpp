// Draws a primitive by its canonical test, sample by sample.

#if defined(ACCEL_TILE_BEAM_RAY_RASTER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_RAY_RASTER_INL
#undef ACCEL_TILE_BEAM_RAY_RASTER_INL
#else
#define ACCEL_TILE_BEAM_RAY_RASTER_INL
#endif

#include "accel/core/canonical_ray.hpp"
#include "accel/tile_beam/sample_raster.hpp"
#include "accel/tile_beam/tile_raster-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// The rays of a tile's samples.
struct TileRays {
  const PrimaryRays& rays;
  const SampleRaster& raster;
  const TileView& view;

  HWY_INLINE Ray at(int x, int y) const { return raster.ray(rays, view.left + x, view.top + y); }
};

/// Draws one sample unless it already has a hit nearer than 1/t = `nearest`. `intersect(ray)`
/// returns t or kMiss for a CanonicalRay.
template <class Intersect>
HWY_INLINE void draw_by_ray(const TileRays& rays, int x, int y, float nearest,
                            scenes::PrimitiveId primitive, TileImage& image, Intersect intersect) {
  const std::size_t at = TileImage::place(x, y);
  if (image.inverse_t[at] > nearest) return;
  const float t = intersect(CanonicalRay(rays.at(x, y)));
  if (!is_hit(t) || !(inverse_of(t) > image.inverse_t[at])) return;
  image.inverse_t[at] = inverse_of(t);
  image.primitive[at] = primitive;
}

/// Draws all samples of `box` in the same way.
template <class Intersect>
HWY_INLINE void draw_by_rays(const TileRays& rays, const SampleRectangle& box, float nearest,
                             scenes::PrimitiveId primitive, TileImage& image, Intersect intersect) {
  for (int y = box.top; y <= box.bottom; ++y) {
    for (int x = box.left; x <= box.right; ++x) {
      draw_by_ray(rays, x, y, nearest, primitive, image, intersect);
    }
  }
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

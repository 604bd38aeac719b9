// Drawing cones into a tile: a box on the screen, then the canonical test for its samples.

#if defined(ACCEL_TILE_BEAM_CONE_RASTER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_CONE_RASTER_INL
#undef ACCEL_TILE_BEAM_CONE_RASTER_INL
#else
#define ACCEL_TILE_BEAM_CONE_RASTER_INL
#endif

#include <bit>

#include "accel/intersect_cone.hpp"
#include "accel/tile_beam/box_probe-inl.hpp"
#include "accel/tile_beam/sample_raster.hpp"
#include "accel/tile_beam/tile_raster-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::HWY_NAMESPACE {

/// Draws the cones of a block. What lies behind `farthest` (1/t) is not drawn.
inline void draw_cones(const ConeBlock& block, const Scene& scene, const PrimaryRays& rays,
                       const SampleRaster& raster, const TileView& view, const BoxProbe& probe,
                       float farthest, TileImage& image) {
  BoxProbe::Met met;
  probe.probe(block.boxes, block.count, farthest, met);
  for (LaneBits left = met.lanes; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(left));
    const Cone& cone = scene.cones[scene.primitives[block.primitives[lane]].index];
    const SampleRectangle box = met.where(lane);
    for (int y = box.top; y <= box.bottom; ++y) {
      for (int x = box.left; x <= box.right; ++x) {
        const std::size_t at = TileImage::place(x, y);
        if (image.inverse_t[at] > met.nearest[lane]) continue;
        const float t =
            intersect_cone(CanonicalRay(raster.ray(rays, view.left + x, view.top + y)), cone);
        if (!is_hit(t) || !(1.0F / t > image.inverse_t[at])) continue;
        image.inverse_t[at] = 1.0F / t;
        image.primitive[at] = block.primitives[lane];
      }
    }
  }
}

}  // namespace beambench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

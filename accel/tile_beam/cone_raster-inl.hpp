// Drawing cones into a tile: a box on the screen, then the canonical test for its samples.

#if defined(ACCEL_TILE_BEAM_CONE_RASTER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_CONE_RASTER_INL
#undef ACCEL_TILE_BEAM_CONE_RASTER_INL
#else
#define ACCEL_TILE_BEAM_CONE_RASTER_INL
#endif

#include <bit>

#include "accel/core/intersect_cone.hpp"
#include "accel/tile_beam/box_probe-inl.hpp"
#include "accel/tile_beam/ray_raster-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Draws the cones of a block. What lies behind `farthest` (1/t) is not drawn.
inline void draw_cones(const ConeBlock& block, const scenes::Scene& scene, const TileRays& rays,
                       const BoxProbe& probe, float farthest, TileImage& image) {
  BoxProbe::Met met;
  probe.probe(block.boxes, block.count, farthest, met);
  for (LaneBits left = met.lanes; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(left));
    const scenes::Cone& cone = scene.cones[scene.primitives[block.primitives[lane]].index];
    draw_by_rays(rays, met.where(lane), met.nearest[lane], block.primitives[lane], image,
                 [&](const CanonicalRay& ray) { return intersect_cone(ray, cone); });
  }
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

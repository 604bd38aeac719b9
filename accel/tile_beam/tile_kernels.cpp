#include "accel/tile_beam/tile_kernels.hpp"

#include <algorithm>
#include <memory>

// Highway includes this file once more for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/tile_beam/tile_kernels.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "accel/tile_beam/ray_walk-inl.hpp"
#include "accel/tile_beam/resolve-inl.hpp"
#include "accel/tile_beam/tile_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::HWY_NAMESPACE {

template <class Counting>
void trace(const TileHierarchy& hierarchy, const Scene& scene, const PrimaryRays& rays,
           HitBuffer& buffer, Counting& counting) {
  const auto image = std::make_unique<TileImage>();
  for (const SampleRaster& raster : sample_rasters(rays)) {
    const RasterView whole(raster, rays, hierarchy.bounds);
    for (int top = 0; top < raster.height; top += kTileHeight) {
      for (int left = 0; left < raster.width; left += kTileWidth) {
        const TileView view(whole, left, top, std::min(kTileWidth, raster.width - left),
                            std::min(kTileHeight, raster.height - top));
        counting.add("beams");
        TileWalk<Counting>(hierarchy, scene, rays, raster, view, *image, counting)();
        resolve(*image, raster, view, buffer);
      }
    }
  }
  hwy::FlushStream();
}

template <class Counting>
constexpr TileRayQueries<Counting> queries() {
  return {closest<Counting>, any<Counting>};
}

const TileKernels& tile_kernels() {
  static constexpr TileKernels kKernels{queries<NoCounting>(),   queries<WorkCounters>(),
                                        queries<StepRecorder>(), {trace<NoCounting>},
                                        {trace<WorkCounters>},   HWY_TARGET};
  return kKernels;
}

}  // namespace beambench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace beambench {

HWY_EXPORT(tile_kernels);

const TileKernels& best_tile_kernels() { return HWY_DYNAMIC_DISPATCH(tile_kernels)(); }

}  // namespace beambench
#endif

#include "accel/tile_beam/tile_trace.hpp"

#include <algorithm>
#include <memory>

#include <hwy/cache_control.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace beambench {
namespace {

/// The tiles of a raster by number, row by row.
class Tiling {
 public:
  Tiling(const SampleRaster& raster, const RasterView& view)
      : raster_(&raster),
        view_(&view),
        columns_((raster.width + kTileWidth - 1) / kTileWidth),
        rows_((raster.height + kTileHeight - 1) / kTileHeight) {}

  int count() const { return columns_ * rows_; }
  TileView operator[](int tile) const {
    const int left = tile % columns_ * kTileWidth;
    const int top = tile / columns_ * kTileHeight;
    return {*view_, left, top, std::min(kTileWidth, raster_->width - left),
            std::min(kTileHeight, raster_->height - top)};
  }

 private:
  const SampleRaster* raster_;
  const RasterView* view_;
  int columns_;
  int rows_;
};

/// What a thread needs of its own.
template <class Counting>
struct Workplace {
  std::unique_ptr<TileImage> image = std::make_unique_for_overwrite<TileImage>();
  Counting counting;
};

}  // namespace

template <class Counting>
void trace_tiles(const TileKernels& kernels, const TileHierarchy& hierarchy, const Scene& scene,
                 const PrimaryRays& rays, bool parallel, HitBuffer& buffer, Counting& counting) {
  tbb::enumerable_thread_specific<Workplace<Counting>> workplaces;
  for (const SampleRaster& raster : sample_rasters(rays)) {
    const RasterView view(raster, rays, hierarchy.bounds);
    const Tiling tiles(raster, view);
    const TilePicture picture{hierarchy, scene, rays, raster};
    const auto draw = [&](int begin, int end) {
      Workplace<Counting>& own = workplaces.local();
      for (int tile = begin; tile < end; ++tile) {
        kernels.drawing<Counting>().draw(picture, tiles[tile], *own.image, buffer, own.counting);
      }
      hwy::FlushStream();
    };
    if (parallel) {
      tbb::parallel_for(tbb::blocked_range(0, tiles.count()),
                        [&](const auto& range) { draw(range.begin(), range.end()); });
    } else {
      draw(0, tiles.count());
    }
  }
  for (const Workplace<Counting>& workplace : workplaces) counting.add(workplace.counting);
}

template void trace_tiles(const TileKernels&, const TileHierarchy&, const Scene&,
                          const PrimaryRays&, bool, HitBuffer&, NoCounting&);
template void trace_tiles(const TileKernels&, const TileHierarchy&, const Scene&,
                          const PrimaryRays&, bool, HitBuffer&, WorkCounters&);

}  // namespace beambench

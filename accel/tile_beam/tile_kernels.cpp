#include "accel/tile_beam/tile_kernels.hpp"

#include "accel/core/pick_target.hpp"

// Highway includes this file again for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/tile_beam/tile_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "accel/tile_beam/ray_walk-inl.hpp"
#include "accel/tile_beam/resolve-inl.hpp"
#include "accel/tile_beam/tile_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

template <class Counting>
void draw(const TilePicture& picture, const TileView& view, TileImage& image, const HitSpan& buffer,
          Counting& counting) {
  counting.add("beams");
  TileWalk<Counting>(picture, view, image, counting)();
  resolve(image, picture.raster, view, buffer);
}

template <class Counting>
constexpr TileRayQueries<Counting> queries() {
  return {closest<Counting>, any<Counting>};
}

template <class Counting>
constexpr TileListQueries<Counting> lists() {
  return {closest_of_list<Counting>, any_of_list<Counting>};
}

const TileKernels& tile_kernels() {
  static constexpr TileKernels kKernels{
      queries<NoCounting>(), queries<WorkCounters>(), queries<StepRecorder>(), lists<NoCounting>(),
      lists<WorkCounters>(), {draw<NoCounting>},      {draw<WorkCounters>},    HWY_TARGET};
  return kKernels;
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace beambench::accel::tile_beam {

HWY_EXPORT(tile_kernels);

const TileKernels& tile_kernels_for(std::int64_t targets) {
  return pick_target(HWY_DISPATCH_TABLE(tile_kernels), targets)();
}

}  // namespace beambench::accel::tile_beam
#endif

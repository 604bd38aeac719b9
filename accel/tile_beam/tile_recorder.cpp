#include "accel/tile_beam/tile_recorder.hpp"

// Uses only the baseline instruction set, which is fast enough for pictures. In the same file as
// the timed kernels, it would affect the inlining of those kernels.
#include <hwy/highway.h>

#include "accel/tile_beam/tile_walk-inl.hpp"

namespace beambench::accel::tile_beam {

void record_tile(const TilePicture& picture, const TileView& view, TileImage& image,
                 HandOverRecorder& recorder) {
  HWY_NAMESPACE::TileWalk<HandOverRecorder>(picture, view, image, recorder)();
}

}  // namespace beambench::accel::tile_beam

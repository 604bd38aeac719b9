#include "accel/tile_beam/tile_recorder.hpp"

// Uses only the baseline instruction set, which is fast enough for pictures. In the file of the
// timed kernels, this code would affect their inlining.
#include <hwy/highway.h>

#include "accel/tile_beam/tile_walk-inl.hpp"

namespace beambench::accel::tile_beam {

void record_tile(const TilePicture& picture, const TileView& view, TileImage& image,
                 HandOverRecorder& recorder) {
  HWY_NAMESPACE::TileWalk<HandOverRecorder>(picture, view, image, recorder)();
}

}  // namespace beambench::accel::tile_beam

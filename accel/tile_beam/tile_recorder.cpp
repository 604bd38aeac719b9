#include "accel/tile_beam/tile_recorder.hpp"

// For the baseline's instructions alone, which is fast enough for pictures. Beside the timed
// kernels it would change what the compiler inlines there.
#include <hwy/highway.h>

#include "accel/tile_beam/tile_walk-inl.hpp"

namespace beambench::accel::tile_beam {

void record_tile(const TilePicture& picture, const TileView& view, TileImage& image,
                 HandOverRecorder& recorder) {
  HWY_NAMESPACE::TileWalk<HandOverRecorder>(picture, view, image, recorder)();
}

}  // namespace beambench::accel::tile_beam

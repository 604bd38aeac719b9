#include "accel/tile_beam/tile_recorder.hpp"

// Uses only the baseline's instructions, which is fast enough for pictures. Next to the timed
// kernels, it would affect the compiler's inlining there.
#include <hwy/highway.h>

#include "accel/tile_beam/tile_walk-inl.hpp"

namespace beambench::accel::tile_beam {

void record_tile(const TilePicture& picture, const TileView& view, TileImage& image,
                 HandOverRecorder& recorder) {
  HWY_NAMESPACE::TileWalk<HandOverRecorder>(picture, view, image, recorder)();
}

}  // namespace beambench::accel::tile_beam

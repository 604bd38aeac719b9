#pragma once
// Records a tile's path through the hierarchy, for pictures.

#include "accel/tile_beam/hand_over.hpp"
#include "accel/tile_beam/tile_kernels.hpp"

namespace beambench::accel::tile_beam {

/// Traverses the hierarchy with a tile like `TileDrawing::draw`, but writes no hits: the image
/// shows whether the tile met anything, and the recorder shows which of its samples were handed
/// over.
void record_tile(const TilePicture& picture, const TileView& view, TileImage& image,
                 HandOverRecorder& recorder);

}  // namespace beambench::accel::tile_beam

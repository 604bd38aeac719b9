#pragma once
// Draws the cells of a structure, or the outlines of its beams, over a picture.

#include <span>
#include <vector>

#include "accel/core/beam_outline.hpp"
#include "accel/core/overlap.hpp"
#include "accel/core/primary_rays.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/picture/legend.hpp"

namespace beambench::render {

/// Dims the picture shown by `rays` and draws the cells over it as glass boxes that hide each
/// other: the edges of faces turned to the camera, unless another cell is in front of them, paler
/// with distance. A cell around the camera shows all its edges and hides nothing. Returns the
/// meaning of the color.
std::vector<LegendEntry> overlay_cells(Image& image, const accel::PrimaryRays& rays,
                                       std::span<const accel::Box> cells);

/// Dims the picture and draws the beams' outlines over it in layers: at the bottom those of beams
/// that leave the scene, then those that continue, and on top those that end at occupied leaves.
/// Where a beam ends, in either way, its area is tinted, because most of the line around it also
/// belongs to other beams. Returns the meaning of the colors.
std::vector<LegendEntry> overlay_beams(Image& image, std::span<const accel::BeamOutline> beams);

}  // namespace beambench::render

#pragma once
// The cells of a structure, or the outlines of its beams, over a picture.

#include <span>
#include <vector>

#include "accel/core/beam_outline.hpp"
#include "accel/core/overlap.hpp"
#include "accel/core/primary_rays.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/picture/legend.hpp"

namespace beambench::render {

/// Dims the picture that `rays` show and draws the cells over it as boxes that hide each other, of
/// glass to what is in them: the edges of faces turned to the camera, where no other cell is
/// in front of them, the paler the farther. A cell around the camera shows all its edges and hides
/// none. Returns what the color stands for.
std::vector<LegendEntry> overlay_cells(Image& image, const accel::PrimaryRays& rays,
                                       std::span<const accel::Box> cells);

/// Dims the picture and draws the beams' outlines over it: those that leave the scene under those
/// that continue under those that end at occupied leaves. Both ends tint their area, for where a
/// line is a beam's end it is mostly that of others, too. Returns what the colors stand for.
std::vector<LegendEntry> overlay_beams(Image& image, std::span<const accel::BeamOutline> beams);

}  // namespace beambench::render

#pragma once
// The outlines of beams over a picture.

#include <span>
#include <vector>

#include "accel/core/beam_outline.hpp"
#include "harness/render/picture/category_legend.hpp"
#include "harness/render/picture/image.hpp"

namespace beambench::render {

/// Dims the picture and draws the beams' outlines over it: those that leave the scene under those
/// that go on under those that end at occupied leaves. Both ends tint their area, for where a line
/// is a beam's end it is mostly that of others, too. Returns what the colors stand for.
std::vector<LegendEntry> overlay_beams(Image& image, std::span<const accel::BeamOutline> beams);

}  // namespace beambench::render

#pragma once
// The outlines of beams over a picture.

#include <span>
#include <vector>

#include "accel/beam_outline.hpp"
#include "harness/picture/category_legend.hpp"
#include "harness/picture/image.hpp"

namespace beambench {

/// Dims the picture and draws the beams' outlines over it: those that leave the scene under those
/// that go on under those that end at occupied leaves. Both ends tint their area, for where a line
/// is a beam's end it is mostly that of others, too. Returns what the colours stand for.
std::vector<LegendEntry> overlay_beams(Image& image, std::span<const BeamOutline> beams);

}  // namespace beambench

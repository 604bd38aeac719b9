#pragma once
// Pictures that are brighter than a display can show.

#include "harness/render/picture/image.hpp"

namespace beambench::render {

/// Multiplies linear light by two to the power of `stops`, as a photographer counts.
void expose(Image& image, double stops);

struct Overexposure {
  double share = 0.0;   ///< of the pixels, those with a component above 1: a display shows it as 1
  double remedy = 0.0;  ///< stops, in tenths, that leave no more than one pixel of a hundred so
};
/// The remedy is 0 where nothing has to be done.
Overexposure overexposure(const Image& image);

}  // namespace beambench::render

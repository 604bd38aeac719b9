#pragma once
// How far a picture is from another.

#include "harness/render/picture/image.hpp"

namespace beambench::render {

/// The root of the mean squared difference of two pictures of one size, over pixels and channels,
/// in display values from 0 to 255 before they are rounded.
double root_mean_square_error(const Image& picture, const Image& reference);

}  // namespace beambench::render

#pragma once
// The order in which rays that come from an image follow each other in lists and batches.

#include <algorithm>
#include <vector>

#include "accel/core/primary_rays.hpp"

namespace beambench::rays {

/// The pixels [left, right) x [top, bottom) of an image.
struct PixelRange {
  int left;
  int top;
  int right;
  int bottom;

  int width() const { return right - left; }
  int height() const { return bottom - top; }
};

/// An image in squares, row by row: their side is 4 times the largest power of two with which a
/// square has at most 4096 samples (64 pixels for one sample a pixel); those at the right and at
/// the bottom are cut off.
std::vector<PixelRange> squares_of(const accel::PrimaryRays& image);

/// Calls `visit(x, y, sample)` for the samples of one of these squares: blocks of 4x4 pixels in
/// Morton order, so that 16, 256 or 4096 samples in succession lie close together; in a block one
/// sample of all its pixels after the other, row by row.
template <class Visit>
void for_each_sample(const PixelRange& square, int samples, const Visit& visit) {
  constexpr int kBlock = 4;
  const auto visit_block = [&](int left, int top) {
    const int right = std::min(left + kBlock, square.right);
    const int bottom = std::min(top + kBlock, square.bottom);
    for (int sample = 0; sample < samples; ++sample) {
      for (int y = top; y < bottom; ++y) {
        for (int x = left; x < right; ++x) visit(x, y, sample);
      }
    }
  };
  // Bits of the place in Morton order: those of x and y in turns.
  const auto every_second_bit = [](unsigned place) {
    unsigned number = 0;
    for (unsigned bit = 0; place >> (2 * bit) != 0; ++bit) number |= (place >> bit) & (1U << bit);
    return static_cast<int>(number);
  };
  const int longer = std::max(square.width(), square.height());
  unsigned blocks = 1;  // of a whole square
  for (int side = kBlock; side < longer; side *= 2) blocks *= 4;
  for (unsigned place = 0; place < blocks; ++place) {
    const int left = square.left + kBlock * every_second_bit(place);
    const int top = square.top + kBlock * every_second_bit(place >> 1U);
    if (left < square.right && top < square.bottom) visit_block(left, top);
  }
}

/// The same for a whole image, square by square.
template <class Visit>
void for_each_sample(const accel::PrimaryRays& image, const Visit& visit) {
  for (const PixelRange& square : squares_of(image)) {
    for_each_sample(square, image.samples(), visit);
  }
}

}  // namespace beambench::rays

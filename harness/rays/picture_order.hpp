#pragma once
// The order of an image's rays in lists and batches.

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

/// The number of samples in a square of a list of rays; the order is the same in all versions.
inline constexpr int kListSquare = 4096;

/// Divides an image into squares, row by row. Their side is 4 times the largest power of two for
/// which a square has at most `samples` samples (64 pixels for 4096, one per pixel), but at least
/// 4; squares at the right and bottom edges are truncated.
std::vector<PixelRange> squares_of(const accel::PrimaryRays& image, int samples);

/// Calls `visit(x, y, sample)` for each sample of one of these squares: blocks of 4x4 pixels in
/// Morton order, so that 16, 256 or 4096 consecutive samples are close together. Within a block,
/// the first sample of each pixel is visited, row by row, then the second samples, and so on.
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
  // The bits of x and y alternate in Morton order.
  const auto every_second_bit = [](unsigned place) {
    unsigned number = 0;
    for (unsigned bit = 0; place >> (2 * bit) != 0; ++bit) number |= (place >> bit) & (1U << bit);
    return static_cast<int>(number);
  };
  const int longer = std::max(square.width(), square.height());
  unsigned blocks = 1;  // in a whole square
  for (int side = kBlock; side < longer; side *= 2) blocks *= 4;
  for (unsigned place = 0; place < blocks; ++place) {
    const int left = square.left + kBlock * every_second_bit(place);
    const int top = square.top + kBlock * every_second_bit(place >> 1U);
    if (left < square.right && top < square.bottom) visit_block(left, top);
  }
}

/// Visits the samples of a whole image in the same way, square by square: the order of lists.
template <class Visit>
void for_each_sample(const accel::PrimaryRays& image, const Visit& visit) {
  for (const PixelRange& square : squares_of(image, kListSquare)) {
    for_each_sample(square, image.samples(), visit);
  }
}

}  // namespace beambench::rays

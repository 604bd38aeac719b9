#include "harness/rays/picture_order.hpp"

namespace beambench::rays {

std::vector<PixelRange> squares_of(const accel::PrimaryRays& image, int samples) {
  int side = 4;
  while (4 * side * side * image.samples() <= samples) side *= 2;
  std::vector<PixelRange> squares;
  for (int top = 0; top < image.height(); top += side) {
    for (int left = 0; left < image.width(); left += side) {
      squares.push_back(
          {left, top, std::min(left + side, image.width()), std::min(top + side, image.height())});
    }
  }
  return squares;
}

}  // namespace beambench::rays

#include "harness/render/picture/raster.hpp"

#include <glm/common.hpp>

namespace beambench::render {

std::optional<std::pair<double, double>> part_on_image(const PixelSegment& line, int width,
                                                       int height, double margin) {
  const glm::dvec2 span = line.to - line.from;
  const glm::dvec2 size(width, height);
  double first = 0.0;
  double last = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double low = -margin - line.from[axis];
    const double high = size[axis] + margin - line.from[axis];
    if (!clip_to_slab(low, high, span[axis], first, last)) return std::nullopt;
  }
  if (!(first <= last)) return std::nullopt;
  return std::pair(first, last);
}

float line_strength(double pixels) {
  constexpr double kClear = 8.0;
  constexpr double kFaintest = 0.35;
  return static_cast<float>(std::clamp(pixels / kClear, kFaintest, 1.0));
}

void LineLayer::add(const PixelSegment& line, double thickness, float strength) {
  for_each_pixel(line, thickness, width_, height_,
                 [&](int x, int y, float coverage, double) { add(x, y, coverage, strength); });
}

void LineLayer::draw_on(Image& image, const Image& ground, const glm::vec3& color) const {
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const Pixel& line = pixels_[i];
    const glm::vec3& below = ground.pixels()[i];
    const glm::vec3 cleared = glm::mix(image.pixels()[i], below, line.coverage);
    // The line adds as much as it has cleared, so that a line of full strength simply covers what
    // is below.
    image.pixels()[i] = cleared + line.strength * (color - below);
  }
}

}  // namespace beambench::render

#pragma once
// The pixels within a convex polygon.

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <glm/vec2.hpp>

namespace beambench::render {

/// Calls `visit(x, y)` for the pixels of an image whose centers lie in a convex polygon (in pixels,
/// (0, 0) being the image's top left corner). Of a center on an edge that two polygons share, only
/// one of them gets the pixel.
template <class Visit>
void for_each_pixel_in(std::span<const glm::dvec2> corners, int width, int height, Visit visit) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  /// The first pixel whose center is at a coordinate or behind it.
  const auto first_from = [](double coordinate, int size) {
    return static_cast<int>(
        std::clamp(std::ceil(coordinate - 0.5), 0.0, static_cast<double>(size)));
  };
  double top = kInfinite;
  double bottom = -kInfinite;
  for (const glm::dvec2& corner : corners) {
    top = std::min(top, corner.y);
    bottom = std::max(bottom, corner.y);
  }
  const int end_row = first_from(bottom, height);
  for (int y = first_from(top, height); y < end_row; ++y) {
    double left = kInfinite;
    double right = -kInfinite;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      // From its lower end, whoever asks: neighbors compute the same number.
      const auto& [upper, lower] =
          std::minmax(corners[i], corners[(i + 1) % corners.size()],
                      [](const glm::dvec2& a, const glm::dvec2& b) { return a.y < b.y; });
      if (!(upper.y <= y + 0.5 && y + 0.5 < lower.y)) continue;
      const double x =
          lower.x + (upper.x - lower.x) * ((lower.y - (y + 0.5)) / (lower.y - upper.y));
      left = std::min(left, x);
      right = std::max(right, x);
    }
    if (!(left < right)) continue;
    const int end = first_from(right, width);
    for (int x = first_from(left, width); x < end; ++x) visit(x, y);
  }
}

}  // namespace beambench::render

#pragma once
// Antialiased straight lines, and filled polygons.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "harness/render/picture/image.hpp"

namespace beambench::render {

/// A line on an image, in pixels; (0, 0) is the image's top left corner.
struct PixelSegment {
  glm::dvec2 from;
  glm::dvec2 to;
};

/// Clips the part [first, last] of a line to `low` <= t * direction <= `high`. Returns false if
/// nothing is left.
inline bool clip_to_slab(double low, double high, double direction, double& first, double& last) {
  if (direction == 0.0) return low <= 0.0 && high >= 0.0;
  const double a = low / direction;
  const double b = high / direction;
  first = std::max(first, std::min(a, b));
  last = std::min(last, std::max(a, b));
  return true;
}

/// Returns the part [first, second] of a line's [0, 1] that lies less than `margin` outside the
/// image (Liang and Barsky, "A new concept and method for line clipping", 1984); nothing if there
/// is none.
std::optional<std::pair<double, double>> part_on_image(const PixelSegment& line, int width,
                                                       int height, double margin);

/// Calls `visit(x, y, coverage, along)` for the pixels of an image that a line of the given
/// thickness covers: `coverage` in (0, 1] approximates the pixel's covered share by the distance of
/// its center from the line; `along` in [0, 1] is the nearest point of the line.
template <class Visit>
void for_each_pixel(const PixelSegment& line, double thickness, int width, int height,
                    Visit visit) {
  const double reach = 0.5 * thickness + 0.5;
  const auto part = part_on_image(line, width, height, reach);
  if (!part) return;
  const glm::dvec2 whole = line.to - line.from;
  const double square = glm::dot(whole, whole);
  const glm::dvec2 first = line.from + whole * part->first;
  const glm::dvec2 last = line.from + whole * part->second;

  // Steps along the axis on which the line is longer, and across it over the line's width.
  const int main = std::abs(whole.x) >= std::abs(whole.y) ? 0 : 1;
  const int cross = 1 - main;
  const glm::ivec2 sizes(width, height);
  const double slope = square > 0.0 ? whole[cross] / whole[main] : 0.0;
  const double span = reach * (1.0 + std::abs(slope));
  const auto pixel = [](double coordinate) { return static_cast<int>(std::floor(coordinate)); };
  const int begin = std::max(pixel(std::min(first[main], last[main]) - reach), 0);
  const int end = std::min(pixel(std::max(first[main], last[main]) + reach), sizes[main] - 1);
  for (int i = begin; i <= end; ++i) {
    const double middle = first[cross] + slope * (i + 0.5 - first[main]);
    const int low = std::max(pixel(middle - span), 0);
    const int high = std::min(pixel(middle + span), sizes[cross] - 1);
    for (int j = low; j <= high; ++j) {
      const glm::ivec2 place = main == 0 ? glm::ivec2(i, j) : glm::ivec2(j, i);
      const glm::dvec2 center = glm::dvec2(place) + 0.5;
      const double along =
          square > 0.0 ? std::clamp(glm::dot(center - line.from, whole) / square, 0.0, 1.0) : 0.0;
      const double coverage =
          std::min(reach - glm::distance(center, line.from + whole * along), 1.0);
      if (coverage > 0.0) visit(place.x, place.y, static_cast<float>(coverage), along);
    }
  }
}

/// Returns the strength, up to 1, of lines around areas of that width in pixels: the closer the
/// lines, the fainter, because otherwise they would fill the picture with their color.
float line_strength(double pixels);

/// Lines of one color, collected before they are drawn: where they overlap, a pixel gets only the
/// strongest of them, so that an edge shared by two neighbors looks like any other.
class LineLayer {
 public:
  LineLayer(int width, int height)
      : width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  int width() const { return width_; }
  int height() const { return height_; }

  /// Adds a pixel that a line covers by `coverage`, drawn with `strength`, both from 0 to 1.
  void add(int x, int y, float coverage, float strength) {
    Pixel& pixel = pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                           static_cast<std::size_t>(x)];
    pixel.coverage = std::max(pixel.coverage, coverage);
    pixel.strength = std::max(pixel.strength, coverage * strength);
  }
  void add(const PixelSegment& line, double thickness, float strength);

  /// Draws the lines over an image of the same size. Even faint lines let only `ground` show
  /// through; otherwise they would mix with the lines of the layers below.
  void draw_on(Image& image, const Image& ground, const glm::vec3& color) const;

 private:
  struct Pixel {
    float coverage = 0.0F;
    float strength = 0.0F;
  };

  int width_;
  int height_;
  std::vector<Pixel> pixels_;
};

/// Calls `visit(x, y)` for the pixels of an image whose centers lie in a convex polygon (in pixels,
/// where (0, 0) is the image's top left corner). If a center is on an edge shared by two polygons,
/// only one of them gets the pixel.
template <class Visit>
void for_each_pixel_in(std::span<const glm::dvec2> corners, int width, int height, Visit visit) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  /// Returns the first pixel whose center is at or after a coordinate.
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
      // Always starts at the lower end, so that neighbors compute the same number.
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

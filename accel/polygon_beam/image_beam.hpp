#pragma once
// A beam's polygon on the image, and the samples in it.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "accel/beam/image_polygon.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/z_buffer/screen.hpp"

namespace beambench::accel::polygon_beam {

using beam::ImageLine;
using beam::ImagePolygon;

/// A sample outside a polygon counts as inside within this distance, in pixels: far more than
/// rounding moves the corners of polygons. So when a polygon is cut, each of its samples is in some
/// part, and samples close to the cut are in both parts.
inline constexpr double kBorder = 1e-6;

/// A beam from the eye: the pyramid through a convex polygon of the image, in pixels.
struct ImageBeam {
  explicit ImageBeam(const ImagePolygon& polygon) : outline(polygon) {
    for (const glm::dvec2& corner : outline) {
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
  }

  /// Returns whether samples of these pixels may be in the beam.
  bool overlaps(const z_buffer::PixelBox& box) const {
    return low.x - kBorder <= box.last[0] + 1 && high.x + kBorder >= box.first[0] &&
           low.y - kBorder <= box.last[1] + 1 && high.y + kBorder >= box.first[1];
  }

  ImagePolygon outline;
  glm::dvec2 low{std::numeric_limits<double>::infinity()};
  glm::dvec2 high{-std::numeric_limits<double>::infinity()};
};

/// Finds the samples of an image in polygons, row by row.
class SampleRows {
 public:
  /// The rays must outlive this object.
  explicit SampleRows(const PrimaryRays& rays)
      : rays_(&rays), all_{{0, 0}, {rays.width() - 1, rays.height() - 1}, 0.0} {}

  /// Returns the pixels of the image.
  const z_buffer::PixelBox& all() const { return all_; }

  /// Calls `visit(y, sample, first_x, last_x)` for the runs of samples in both a polygon and a box,
  /// until it returns true. Returns whether it returned true.
  template <class Visit>
  bool find_run(const ImagePolygon& polygon, const z_buffer::PixelBox& box, Visit visit) const {
    double top = std::numeric_limits<double>::infinity();
    double bottom = -top;
    for (const glm::dvec2& corner : polygon) {
      top = std::min(top, corner.y);
      bottom = std::max(bottom, corner.y);
    }
    for (int sample = 0; sample < rays_->samples(); ++sample) {
      const glm::dvec2& offset = rays_->offsets()[static_cast<std::size_t>(sample)];
      const int first_y = first_from(top - offset.y, box.first[1]);
      const int last_y = last_until(bottom - offset.y, box.last[1]);
      for (int y = first_y; y <= last_y; ++y) {
        const Span span = span_at(polygon, y + offset.y);
        const int first = first_from(span.left - offset.x, box.first[0]);
        const int last = last_until(span.right - offset.x, box.last[0]);
        if (first <= last && visit(y, sample, first, last)) return true;
      }
    }
    return false;
  }

  bool any_in(const ImagePolygon& polygon) const {
    return find_run(polygon, all_, [](int, int, int, int) { return true; });
  }

 private:
  struct Span {
    double left = std::numeric_limits<double>::infinity();
    double right = -left;
  };

  /// Returns the part of a row that the polygon covers; the row is widened by `kBorder` on both
  /// sides.
  static Span span_at(const ImagePolygon& polygon, double y) {
    Span span;
    const std::array<double, 2> ends{y - kBorder, y + kBorder};
    glm::dvec2 last = polygon[polygon.size() - 1];
    for (const glm::dvec2& corner : polygon) {
      const glm::dvec2 from = last;
      last = corner;
      if (std::max(from.y, corner.y) < ends[0] || std::min(from.y, corner.y) > ends[1]) continue;
      const glm::dvec2 edge = corner - from;
      for (std::size_t i = 0; i < ends.size(); ++i) {
        const double along = edge.y != 0.0 ? std::clamp((ends[i] - from.y) / edge.y, 0.0, 1.0)
                                           : static_cast<double>(i);
        const double x = from.x + edge.x * along;
        span.left = std::min(span.left, x);
        span.right = std::max(span.right, x);
      }
    }
    return span;
  }
  // Computed in double, because `place` may be far outside the image.
  static int first_from(double place, int least) {
    return static_cast<int>(
        std::clamp(std::ceil(place - kBorder), static_cast<double>(least), kBeyond));
  }
  static int last_until(double place, int most) {
    return static_cast<int>(
        std::clamp(std::floor(place + kBorder), -1.0, static_cast<double>(most)));
  }
  static constexpr double kBeyond = 1e6;

  const PrimaryRays* rays_;
  z_buffer::PixelBox all_;
};

}  // namespace beambench::accel::polygon_beam

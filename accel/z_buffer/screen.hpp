#pragma once
// Conservative bounds of primitives on the screen, including rounding errors.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include <glm/geometric.hpp>

#include "accel/core/primary_rays.hpp"

namespace beambench::accel::z_buffer {

/// A ball relative to the eye. Primitives lie in the convex hull of a few balls; a corner is a
/// small ball.
struct Ball {
  glm::dvec3 center;
  double radius;
};

/// The pixels from `first` to `last` along both axes of an image, and a lower bound on the view
/// depth of everything visible there.
struct PixelBox {
  std::array<int, 2> first{0, 0};
  std::array<int, 2> last{-1, -1};
  double nearest = 0.0;

  bool empty() const { return first[0] > last[0] || first[1] > last[1]; }
};

/// The linear function x * px + y * py + constant of a place on the image in pixels.
struct PixelLine {
  double x;
  double y;
  double constant;

  double at(double px, double py) const { return x * px + (y * py + constant); }
};

/// The image plane, as seen from the eye: the direction through a place in pixels is top_left +
/// right * px + down * py, and has view depth 1.
class Screen {
 public:
  /// The rays must outlive the screen.
  explicit Screen(const PrimaryRays& rays)
      : rays_(&rays),
        axes_{axis_of(rays, rays.right(), 0, rays.width()),
              axis_of(rays, rays.down(), 1, rays.height())} {
    for (const double x : {0.0, 1.0}) {
      for (const double y : {0.0, 1.0}) {
        longest_ = std::max(longest_,
                            glm::length(rays.top_left() + rays.across() * x + rays.all_down() * y));
      }
    }
  }

  /// Returns the length of the longest direction.
  double longest() const { return longest_; }
  /// Returns a bound on the distance between a ray's direction, rounded to float, and that of its
  /// sample: four times the effect of components with relative errors of 2^-24.
  double rounding() const { return 0x1p-22 * longest_; }
  double depth(const glm::dvec3& point) const { return glm::dot(point, rays_->forward()); }

  /// Returns the product of `normal` and a sample's direction, plus `slack` for rounding, as a
  /// function of the sample's place.
  PixelLine product(const glm::dvec3& normal, double slack) const {
    return {glm::dot(normal, rays_->right()), glm::dot(normal, rays_->down()),
            glm::dot(normal, rays_->top_left()) + slack};
  }

  /// Returns a box that contains every sample whose ray may meet the convex hull of the balls: the
  /// whole image if the hull crosses the plane of the eye, and an empty box if the hull lies behind
  /// the eye.
  PixelBox box_of(std::span<const Ball> hull) const {
    PixelBox box{{0, 0}, {axes_[0].last, axes_[1].last}, 0.0};
    bool all_behind = true;
    bool all_in_front = true;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Ball& ball : hull) {
      const double at = depth(ball.center);
      all_behind = all_behind && at < -ball.radius;
      // Require the ball to be slightly in front, so that the tangents below are accurate.
      all_in_front = all_in_front && at > 1.001 * ball.radius;
      nearest = std::min(nearest, at - ball.radius);
    }
    if (all_behind) return {};
    if (!all_in_front) return box;
    box.nearest = nearest * std::max(0.0, 1.0 - rounding());
    for (std::size_t i = 0; i < 2; ++i) set_range(axes_[i], hull, box.first[i], box.last[i]);
    return box;
  }

 private:
  /// The columns or rows of an image.
  struct Axis {
    glm::dvec3 unit;  ///< the direction from one pixel to the next
    double pixels;    ///< per unit of length at view depth 1
    double origin;    ///< position of the first pixel, in these units
    double low;       ///< lowest and highest position of a sample in its pixel
    double high;
    int last;
  };

  static Axis axis_of(const PrimaryRays& rays, const glm::dvec3& step, int component, int size) {
    const auto [low, high] = std::ranges::minmax(
        rays.offsets(), {}, [&](const glm::dvec2& offset) { return offset[component]; });
    const glm::dvec3 unit = glm::normalize(step);
    return {unit,           1.0 / glm::length(step), glm::dot(rays.top_left(), unit),
            low[component], high[component],         size - 1};
  }

  /// Narrows the pixels from `first` to `last` to those that the balls cover; each ball lies
  /// between its tangents from the eye. All balls must lie in front of the eye.
  void set_range(const Axis& axis, std::span<const Ball> hull, int& first, int& last) const {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Ball& ball : hull) {
      const double side = glm::dot(ball.center, axis.unit);
      const double at = depth(ball.center);
      const double squared = at * at - ball.radius * ball.radius;
      const double root = ball.radius * std::sqrt(side * side + squared);
      low = std::min(low, (side * at - root) / squared);
      high = std::max(high, (side * at + root) / squared);
    }
    const auto pixel = [&](double place) { return (place - axis.origin) * axis.pixels; };
    // Positions may be far outside the image, beyond the range of integers.
    first = static_cast<int>(
        std::clamp(std::ceil(pixel(low - 2.0 * rounding()) - axis.high), 0.0, axis.last + 1.0));
    last = static_cast<int>(std::clamp(std::floor(pixel(high + 2.0 * rounding()) - axis.low), -1.0,
                                       static_cast<double>(axis.last)));
  }

  const PrimaryRays* rays_;
  double longest_ = 0.0;
  std::array<Axis, 2> axes_;
};

}  // namespace beambench::accel::z_buffer

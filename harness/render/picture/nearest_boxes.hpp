#pragma once
// Which of many boxes is nearest to the eye in each pixel.

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "accel/core/overlap.hpp"
#include "harness/render/picture/projection.hpp"

namespace beambench::render {

/// Decides what boxes hide: a box buffer (Catmull's z-buffer, 1974, that remembers the box, so that
/// a depth can be asked for between the pixels' centers). Boxes around the eye hide nothing.
class NearestBoxes {
 public:
  /// The boxes must outlive it.
  NearestBoxes(const Projection& projection, int width, int height,
               std::span<const accel::Box> boxes);

  /// Is a point that appears at `place`, at this depth, behind a box? `x` and `y` are the pixel
  /// that shall show it; the answer is exact if that pixel or the one around `place` shows the box.
  bool hide(int x, int y, const glm::dvec2& place, double depth) const;

  struct Range {
    double nearest;
    double farthest;
  };
  /// Of the depths in all pixels that see a box.
  Range depths() const { return range_; }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  void add(std::uint32_t box);
  bool hidden_by(std::uint32_t box, const glm::dvec2& place, double depth) const;
  std::uint32_t at(int x, int y) const;

  Projection projection_;
  int width_;
  int height_;
  std::span<const accel::Box> boxes_;
  std::vector<std::uint32_t> nearest_;  ///< kNone where no box is seen
  std::vector<double> depths_;
  Range range_{std::numeric_limits<double>::infinity(), 0.0};
};

}  // namespace beambench::render

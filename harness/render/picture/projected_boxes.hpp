#pragma once
// Boxes in the perspective of an image: their edges, and which of them is nearest in each pixel.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "accel/core/overlap.hpp"
#include "accel/core/primary_rays.hpp"
#include "harness/render/picture/raster.hpp"

namespace beambench::render {

/// The perspective of an image.
class Projection {
 public:
  explicit Projection(const accel::PrimaryRays& rays)
      : eye_(rays.eye()),
        forward_(rays.forward()),
        top_left_(rays.top_left()),
        right_(rays.right()),
        down_(rays.down()) {}

  const glm::dvec3& eye() const { return eye_; }
  /// Along the view direction: 0 in the eye's plane, negative behind it.
  double depth(const glm::dvec3& point) const { return glm::dot(point - eye_, forward_); }
  /// Where a point of depth > 0 appears, in pixels; (0, 0) is the image's top left corner.
  glm::dvec2 place(const glm::dvec3& point) const {
    const glm::dvec3 offset = (point - eye_) / depth(point) - top_left_;
    return {glm::dot(offset, right_) / glm::dot(right_, right_),
            glm::dot(offset, down_) / glm::dot(down_, down_)};
  }
  /// From the eye through a place to depth 1: `t` along it is depth.
  glm::dvec3 direction(const glm::dvec2& place) const {
    return top_left_ + right_ * place.x + down_ * place.y;
  }
  /// So many pixels wide is a unit length at depth 1.
  double scale() const { return 1.0 / glm::length(right_); }

 private:
  glm::dvec3 eye_;
  glm::dvec3 forward_;
  glm::dvec3 top_left_;
  glm::dvec3 right_;
  glm::dvec3 down_;
};

/// An edge on the image: of what lies in front of the eye.
struct SeenEdge {
  PixelSegment line;
  double from_depth;
  double to_depth;

  /// The depth of the point at `along` in [0, 1] of the line: its inverse is linear on the image.
  double depth_at(double along) const {
    return 1.0 / ((1.0 - along) / from_depth + along / to_depth);
  }
};

struct BoxEdge {
  glm::dvec3 from;
  glm::dvec3 to;
  bool turned_to_eye;  ///< belongs to a face that the eye is in front of
};

/// Is the eye in the closed box?
bool holds(const accel::Box& box, const glm::dvec3& eye);

/// All edges, along x, along y, along z. Around an eye within the box no face is turned away: it
/// sees each from inside.
std::array<BoxEdge, 12> box_edges(const accel::Box& box, const glm::dvec3& eye);

/// An edge cut off at the eye's plane; nothing where all of it lies behind.
std::optional<SeenEdge> project(const BoxEdge& edge, const Projection& projection);

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

#pragma once
// The edges of a box as an eye sees them.

#include <array>
#include <optional>

#include <glm/vec3.hpp>

#include "accel/core/overlap.hpp"
#include "harness/render/picture/line.hpp"
#include "harness/render/picture/projection.hpp"

namespace beambench::render {

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

}  // namespace beambench::render

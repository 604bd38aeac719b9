#pragma once
// What a structure that traces in beams shows of them.

#include <vector>

#include <glm/vec2.hpp>

namespace beambench::accel {

/// What a beam meets (thesis, section 3.2).
enum class BeamKind {
  kNonTerminal,  ///< an empty leaf: it goes on
  kOccupied,     ///< a leaf with references: its samples become rays
  kLeaving       ///< the end of the scene: its samples show the background
};

/// A beam's cross-section on the image.
struct BeamOutline {
  BeamKind kind;
  /// Of a convex polygon, in pixels; (0, 0) is the image's top left corner.
  std::vector<glm::dvec2> corners;
};

}  // namespace beambench::accel

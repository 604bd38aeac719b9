#pragma once
// The beams of a structure that traces in beams, for pictures.

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>

namespace beambench::accel {

/// The kind of a beam, by what it meets (thesis, section 3.2).
enum class BeamKind {
  kNonTerminal,  ///< an empty leaf: the beam continues
  kOccupied,     ///< a leaf with references: the beam's samples become rays
  kLeaving       ///< the boundary of the scene: the beam's samples are background
};

/// A beam's cross-section on the image, and its samples.
struct BeamOutline {
  BeamKind kind;
  /// The corners of a convex polygon, in pixels; (0, 0) is the image's top left corner.
  std::vector<glm::dvec2> corners;
  /// The leaf that the beam enters, as `TraceStep::index`; for a leaving beam, the leaf from which
  /// it comes.
  std::size_t node = 0;
  /// The samples that the beam decided or turned into rays, numbered as in a HitBuffer, in
  /// increasing order. Empty for a leaving beam.
  std::vector<std::size_t> samples{};
};

}  // namespace beambench::accel

#pragma once
// A beam in a leaf, a step on the path of a sample.

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "accel/core/beam_outline.hpp"
#include "accel/core/overlap.hpp"

namespace beambench::accel {

/// A plane that rays cross: its `axis` (0, 1 or 2) and its coordinate on this axis, in scene units.
struct CrossedPlane {
  int axis;
  double at;
};

/// A cut between two beams: the rays of this beam cross `first` before `second`.
struct PlaneOrder {
  CrossedPlane first;
  CrossedPlane second;
};

/// A beam in a leaf. A beam that continues undivided is the same beam in the next leaf.
struct BeamPassage {
  BeamKind kind = BeamKind::kNonTerminal;
  std::uint32_t node = 0;               ///< the leaf entered; for a leaving beam, the last leaf
  int level = 0;                        ///< of that leaf, the root being level 1
  Box cell{};                           ///< that leaf, in scene units
  std::optional<CrossedPlane> entered;  ///< the leaf's face; nothing if the camera is in the leaf
  std::vector<glm::dvec2> corners;      ///< of its outline, in pixels from the top left
  std::vector<PlaneOrder> cuts;  ///< new since the last passage; empty if it continued undivided
  std::uint64_t samples = 0;     ///< number of the image's samples in the beam
};

}  // namespace beambench::accel

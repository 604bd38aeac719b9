#pragma once
// The traversal path of one sample: the beams that it belongs to, and the ray that it becomes.

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "accel/beam/beam_tracer.hpp"

namespace beambench::accel::beam {

/// A plane that rays cross: `axis` 0, 1 or 2, and its coordinate on that axis, in scene units.
struct CrossedPlane {
  int axis;
  double at;
};

/// A cut between two beams: the rays of this one cross `first` before `second`.
struct PlaneOrder {
  CrossedPlane first;
  CrossedPlane second;
};

/// A beam in a leaf. A beam that continues undivided is the same beam in the next leaf.
struct BeamPassage {
  BeamKind kind = BeamKind::kNonTerminal;
  std::uint32_t node = 0;  ///< the leaf it enters; of a leaving beam the one it comes from
  int level = 0;           ///< of that leaf, the root being level 1
  Box cell{};              ///< that leaf, in scene units
  std::optional<CrossedPlane> entered;  ///< the leaf's face; nothing if the camera is in the leaf
  std::vector<glm::dvec2> corners;      ///< of its outline, in pixels from the top left
  std::vector<PlaneOrder> cuts;  ///< new since the last passage; none: it continued undivided
  std::uint64_t samples = 0;     ///< of the image, in it
};

/// The traversal path of a sample.
struct SamplePath {
  std::vector<BeamPassage> beams;   ///< from the first to the one it ends in; none: past the root
  std::vector<TraceStep> steps;     ///< leaves whose references were tested, with each test
  std::optional<RayReason> reason;  ///< why it became a ray of its own; nothing where it did not
  std::optional<Hit> hit;
};

/// Follows one sample as `BeamTracer::trace` does: the same beams, the same tests. Beams that the
/// sample does not belong to are divided as well, but none of their samples is traced.
SamplePath path_of_sample(const BeamTracer& tracer, const PrimaryRays& rays, int x, int y,
                          int sample);

}  // namespace beambench::accel::beam

#pragma once
// The traversal path of one sample: the beams that it belongs to, and the ray that it becomes.

#include <optional>
#include <vector>

#include "accel/beam/beam_tracer.hpp"
#include "accel/core/beam_passage.hpp"

namespace beambench::accel::beam {

/// The traversal path of a sample.
struct SamplePath {
  std::vector<BeamPassage> beams;   ///< from the first to the one it ends in; none: past the root
  std::vector<TraceStep> steps;     ///< leaves whose references were tested, with each test
  std::optional<RayReason> reason;  ///< why it became a ray of its own; nothing where it did not
  std::optional<Hit> hit;
};

/// Follows one sample as `BeamTracer::closest_hits` does: the same beams, the same tests. Beams
/// that the sample does not belong to are divided as well, but none of their samples is traced.
SamplePath path_of_sample(const BeamTracer& tracer, const PrimaryRays& rays, int x, int y,
                          int sample);

}  // namespace beambench::accel::beam

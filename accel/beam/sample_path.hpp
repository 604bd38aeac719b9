#pragma once
// The traversal path of one sample: its beams, and its individual ray, if any.

#include <optional>
#include <vector>

#include "accel/beam/beam_tracer.hpp"
#include "accel/core/beam_passage.hpp"

namespace beambench::accel::beam {

/// The traversal path of a sample.
struct SamplePath {
  std::vector<BeamPassage> beams;   ///< first to last; empty if the ray misses the root
  std::vector<TraceStep> steps;     ///< leaves whose references were tested, with each test
  std::optional<RayReason> reason;  ///< why the sample became a ray; nothing if it did not
  std::optional<Hit> hit;
};

/// Follows one sample exactly as `BeamTracer::closest_hits` does: the same beams, the same tests.
/// Beams that do not contain the sample are also divided, but their samples are not traced.
SamplePath path_of_sample(const BeamTracer& tracer, const PrimaryRays& rays, int x, int y,
                          int sample);

}  // namespace beambench::accel::beam

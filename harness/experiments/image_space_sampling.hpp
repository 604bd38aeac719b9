#pragma once
// How many samples a pixel gets, chosen by how much it differs from its neighbors.

#include "accel/beam/object_space_sampling.hpp"
#include "scenes/scene.hpp"

namespace beambench::experiments {

/// Contrast between pixels: the largest difference of a channel's display values, 0 to 1.
struct SamplingContrast {
  double few = 0.05;   ///< to one of the four neighbors: the pixel gets 5 samples instead of 1
  double many = 0.30;  ///< it gets 25
};

/// Adaptive sampling in image space (after Whitted 1980, section 4, who compares the corners of
/// pixels): one sample a pixel is traced by beams and shaded; pixels that differ from a neighbor
/// get more, as individual rays. `rays` must have 25 samples a pixel (std::invalid_argument).
accel::beam::SparseSamples trace_image_space(const accel::beam::BeamTracer& tracer,
                                             const scenes::Scene& scene,
                                             const scenes::Camera& camera,
                                             const accel::PrimaryRays& rays,
                                             const SamplingContrast& contrast);

}  // namespace beambench::experiments

#pragma once
// Ways of choosing the number of samples of a pixel, side by side.

#include <string>
#include <vector>

#include "accel/beam/object_space_sampling.hpp"
#include "harness/base/progress.hpp"
#include "harness/rays/trace_input.hpp"
#include "scenes/scene.hpp"

namespace beambench::experiments {

/// What one way of sampling an image took, and how good its picture is.
struct SamplingResult {
  std::string method;   ///< `uniform`, `object-space` or `image-space`
  std::string setting;  ///< samples a pixel, or from which value on a pixel gets 5 and 25
  double rays;          ///< a pixel, on average; samples of leaving beams cost none
  double trace_ms;      ///< tracing and choosing, without the final shading; median
  double error;         ///< root mean square, of 255, against 64 samples a pixel
};

/// What compare_sampling reports on: its steps.
std::size_t sampling_steps();

/// Traces the image by uniform, object-space and image-space sampling at several settings, each
/// `repetitions` times. Throws InputError where the image is too large for 64 samples a pixel.
std::vector<SamplingResult> compare_sampling(const accel::beam::BeamTracer& tracer,
                                             const scenes::Scene& scene,
                                             const rays::ImageOfRays& image, int repetitions,
                                             base::Progress& progress);

/// How many of the samples lie in each pixel, row by row.
std::vector<float> samples_by_pixel(const accel::beam::SparseSamples& samples);

}  // namespace beambench::experiments

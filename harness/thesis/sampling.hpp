#pragma once
// Methods of choosing the number of samples per pixel, in image space and in object space, and
// their comparison.

#include <string>
#include <vector>

#include "accel/beam/object_space_sampling.hpp"
#include "harness/base/progress.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/render/picture/image.hpp"
#include "scenes/scene.hpp"

namespace beambench::thesis {

/// Thresholds for the contrast between pixels: the largest difference in a channel's display
/// values, from 0 to 1.
struct SamplingContrast {
  double few = 0.05;   ///< threshold for 5 samples, of the contrast to any of the four neighbors
  double many = 0.30;  ///< threshold for 25 samples
};

/// Adaptive sampling in image space (after Whitted 1980, section 4, who compares the corners of
/// pixels): one sample per pixel is traced by beams and shaded; pixels that differ from a neighbor
/// get more samples, as individual rays. `rays` must have 25 samples per pixel
/// (std::invalid_argument).
accel::beam::SparseSamples trace_image_space(const accel::beam::BeamTracer& tracer,
                                             const scenes::Scene& scene,
                                             const scenes::Camera& camera,
                                             const accel::PrimaryRays& rays,
                                             const SamplingContrast& contrast);

/// Draws the picture of sparse samples, in the colors of `Shading::kPreview`. Each of a pixel's n
/// samples represents 1/n of the pixel. Any remaining part of the pixel is background. If the parts
/// exceed the pixel, because leaves with different n meet in it, the parts are scaled down to fit.
render::Image sparse_image(const scenes::Scene& scene, const accel::PrimaryRays& rays,
                           const accel::beam::SparseSamples& samples);

/// Cost and error of one sampling method with one setting.
struct SamplingResult {
  std::string method;   ///< `uniform`, `object-space` or `image-space`
  std::string setting;  ///< samples per pixel, or the thresholds for 5 and 25 samples
  double rays;          ///< per pixel, on average; samples of leaving beams need no rays
  double trace_ms;      ///< median time of tracing and choosing, without the final shading
  double error;         ///< RMS error on a 0-255 scale against 64 samples per pixel
};

/// Returns the number of steps (`Progress` cells) that `compare_sampling` reports.
std::size_t sampling_steps();

/// Traces the image with uniform, object-space and image-space sampling at several settings, each
/// `repetitions` times. Throws InputError if the image is too large for 64 samples per pixel.
std::vector<SamplingResult> compare_sampling(const accel::beam::BeamTracer& tracer,
                                             const scenes::Scene& scene,
                                             const rays::ImageOfRays& image, int repetitions,
                                             base::Progress& progress);

/// Returns the number of samples in each pixel, row by row.
std::vector<float> samples_by_pixel(const accel::beam::SparseSamples& samples);

}  // namespace beambench::thesis

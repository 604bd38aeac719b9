#pragma once
// From samples that not every pixel has alike to a picture.

#include "accel/beam/object_space_sampling.hpp"
#include "harness/render/picture/image.hpp"
#include "scenes/scene.hpp"

namespace beambench::experiments {

/// The picture of sparse samples, in the colors of `Shading::kPreview`. Each sample stands for
/// 1/number of its pixel; what is left of the pixel is background, and where the parts are more
/// than a pixel, because leaves with other numbers of samples meet there, they are scaled to it.
render::Image sparse_image(const scenes::Scene& scene, const accel::PrimaryRays& rays,
                           const accel::beam::SparseSamples& samples);

}  // namespace beambench::experiments

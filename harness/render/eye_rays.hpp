#pragma once
// The rays that a picture begins with.

#include <functional>

#include "accel/core/primary_rays.hpp"
#include "accel/core/ray.hpp"
#include "scenes/camera.hpp"

namespace beambench::render {

/// width x height pixels of `samples` rays each; `ray(x, y, sample)`, (0, 0) being the top left.
struct EyeRays {
  int width;
  int height;
  int samples;
  std::function<accel::Ray(int x, int y, int sample)> ray;
};

/// Those of an image. `rays` must outlive them.
inline EyeRays eye_rays(const accel::PrimaryRays& rays) {
  return {rays.width(), rays.height(), rays.samples(),
          [&rays](int x, int y, int sample) { return rays.ray(x, y, sample); }};
}

/// Those of Haines's Standard Procedural Databases: through the corners of 512 x 512 pixels, one
/// sample for each of the 513 x 513 corners.
inline EyeRays corner_rays(const scenes::Camera& camera) {
  constexpr int kPixels = 512;
  return {kPixels + 1, kPixels + 1, 1,
          [rays = accel::PrimaryRays(camera, kPixels, kPixels, 1)](int x, int y, int) {
            return rays.ray_at(x, y);
          }};
}

}  // namespace beambench::render

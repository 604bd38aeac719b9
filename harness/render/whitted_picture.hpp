#pragma once
// The rays that a picture begins with.

#include <cstddef>
#include <functional>
#include <span>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/core/ray.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/whitted.hpp"
#include "scenes/camera.hpp"

namespace beambench::render {

/// width x height pixels of `samples` rays each; `ray(x, y, sample)`, (0, 0) being the top left.
struct CameraRays {
  int width;
  int height;
  int samples;
  std::function<accel::Ray(int x, int y, int sample)> ray;
};

/// Those of an image. `rays` must outlive them.
inline CameraRays camera_rays(const accel::PrimaryRays& rays) {
  return {rays.width(), rays.height(), rays.samples(),
          [&rays](int x, int y, int sample) { return rays.ray(x, y, sample); }};
}

/// Those of Haines's Standard Procedural Databases: through the corners of 512 x 512 pixels, one
/// sample for each of the 513 x 513 corners.
inline CameraRays corner_rays(const scenes::Camera& camera) {
  constexpr int kPixels = 512;
  return {kPixels + 1, kPixels + 1, 1,
          [rays = accel::PrimaryRays(camera, kPixels, kPixels, 1)](int x, int y, int) {
            return rays.ray_at(x, y);
          }};
}

struct WhittedPicture {
  Image image;
  RayCensus census;
};

/// Called from time to time, on the calling thread, with the part that is done (0 ... 1).
using PictureWatch = std::function<void(double part)>;

/// Each pixel is the mean of its samples. `hits` are the structure's answers to `rays`, found
/// beforehand by whatever way it has for whole images (beams); what follows them goes ray by ray.
/// Rows are shared among TBB's threads, at most `threads` of them unless it is 0; picture and
/// census do not depend on how many there are.
WhittedPicture whitted_picture(const Whitted& tracer, const CameraRays& rays,
                               const accel::HitBuffer& hits, const PictureWatch& watch = {},
                               int threads = 0);

/// The same picture (but for rounding, with several samples a pixel) with its samples shaded in the
/// order of `places` in the hit buffer, each of which is there once: on this thread alone, with one
/// shadow cache, which all that is counted of the cache depends on.
WhittedPicture whitted_picture_along(std::span<const std::size_t> places, const Whitted& tracer,
                                     const CameraRays& rays, const accel::HitBuffer& hits,
                                     const PictureWatch& watch = {});

/// The same picture into `image`, which has its size, on this thread alone; returns its census.
RayCensus draw_in_order(const Whitted& tracer, const CameraRays& rays, const accel::HitBuffer& hits,
                        Image& image);

}  // namespace beambench::render

#pragma once
// Pictures by the whole ray tracer, on all threads.

#include <cstddef>
#include <functional>
#include <span>

#include "accel/core/hit_buffer.hpp"
#include "harness/render/eye_rays.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/whitted.hpp"

namespace beambench::render {

struct WhittedPicture {
  Image image;
  RayCensus census;
};

/// Told from time to time, on the calling thread, how much is done (0 ... 1).
using PictureWatch = std::function<void(double part)>;

/// Each pixel is the mean of its samples. `hits` are the structure's answers to `rays`, found
/// beforehand by whatever way it has for whole images (beams); what follows them goes ray by ray.
/// Rows are shared among TBB's threads; picture and census do not depend on how many there are.
WhittedPicture whitted_picture(const Whitted& tracer, const EyeRays& rays,
                               const accel::HitBuffer& hits, const PictureWatch& watch = {});

/// The same picture (but for rounding, with several samples a pixel) with its samples shaded in the
/// order of `places` in the hit buffer, each of which is there once: on this thread alone, with one
/// shadow cache, which all that is counted of the cache depends on.
WhittedPicture whitted_picture_along(std::span<const std::size_t> places, const Whitted& tracer,
                                     const EyeRays& rays, const accel::HitBuffer& hits,
                                     const PictureWatch& watch = {});

/// The same picture into `image`, which has its size, on this thread alone; returns its census.
RayCensus draw_in_order(const Whitted& tracer, const EyeRays& rays, const accel::HitBuffer& hits,
                        Image& image);

}  // namespace beambench::render

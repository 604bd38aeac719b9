#pragma once
// The whole picture, and the order in which its samples are shaded.

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "accel/core/accelerator.hpp"
#include "accel/core/hit_buffer.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/core/ray.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/whitted.hpp"
#include "scenes/camera.hpp"

namespace beambench::render {

/// The camera rays of Haines's Standard Procedural Databases: through the corners of 512 x 512
/// pixels.
inline accel::PrimaryRays corner_rays(const scenes::Camera& camera) {
  return accel::PrimaryRays(camera, 512, 512, 1).at_corners();
}

struct WhittedPicture {
  Image image;
  RayCensus census;
};

/// Called from time to time, on the calling thread, with the part that is done (0 ... 1).
using PictureWatch = std::function<void(double part)>;

/// Each pixel is the mean of its samples. `hits` are the structure's answers to `rays`, found
/// beforehand by its own query for whole images (beams). Parts of the picture are shared among
/// `threads` threads (`accel::thread_count`); picture and census do not depend on how many there
/// are. A part is a square of pixels in the order of `rays::for_each_sample`, so that
/// neighbors in a batch of rays are neighbors in the picture; with the shadow cache it is a row,
/// from left to right, in which the cache begins anew.
WhittedPicture whitted_picture(const Whitted& tracer, const accel::PrimaryRays& rays,
                               const accel::HitBuffer& hits, const PictureWatch& watch = {},
                               int threads = 0);

/// The same picture (but for rounding, with several samples a pixel) with its samples shaded in the
/// order of `places` in the hit buffer, each of which is there once: on this thread alone, with one
/// shadow cache, which all that is counted of the cache depends on.
WhittedPicture whitted_picture_along(std::span<const std::size_t> places, const Whitted& tracer,
                                     const accel::PrimaryRays& rays, const accel::HitBuffer& hits,
                                     const PictureWatch& watch = {});

/// The same picture into `image`, which has its size, on this thread alone; returns its census.
RayCensus draw_in_order(const Whitted& tracer, const accel::PrimaryRays& rays,
                        const accel::HitBuffer& hits, Image& image);

/// What a shadow cache remembers depends on which samples follow each other.
enum class ShadingOrder {
  kRows,  ///< row by row, the cache begins anew in each; rows may be shared among threads
  kScan,  ///< pixel by pixel along the rows, with one cache
  kBeams  ///< beam by beam, with one cache: what the thesis expects a cache to gain by (6.2.2)
};

/// `rows`, `scan`, `beams`. Throws InputError for another name.
ShadingOrder parse_shading_order(std::string_view name);

/// The places in the hit buffer of all samples along the rows.
std::vector<std::size_t> scan_order(const accel::PrimaryRays& rays);

/// The same places as beams decide them: those of a beam are together, along the rows; then those
/// that no beam at an occupied leaf had. Throws InputError for a structure that traces no beams.
std::vector<std::size_t> beam_order(const accel::Accelerator& structure,
                                    const accel::PrimaryRays& rays);

}  // namespace beambench::render

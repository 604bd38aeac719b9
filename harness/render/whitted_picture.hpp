#pragma once
// Draws whole pictures, and defines the order in which their samples are shaded.

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

/// Called from time to time on the calling thread with the fraction done (0 ... 1).
using PictureWatch = std::function<void(double part)>;

/// Draws the picture; each pixel is the mean of its samples. `hits` are the structure's results for
/// `rays`, found in advance by its own query for whole images (beams). Parts of the picture are
/// shared among `threads` threads (`accel::thread_count`); picture and census do not depend on
/// their number. A part is a square of pixels in the order of `rays::for_each_sample`, so that
/// neighbors in a batch of rays are neighbors in the picture. With the shadow cache, a part is a
/// row, from left to right, and the cache is empty at its beginning. A square has at most as many
/// samples as a batch, whatever the number of threads, because hits of pencils may depend on the
/// batch.
WhittedPicture whitted_picture(const Whitted& tracer, const accel::PrimaryRays& rays,
                               const accel::HitBuffer& hits, const PictureWatch& watch = {},
                               int threads = 0);

/// Draws the same picture (up to rounding, if there are several samples per pixel), shading its
/// samples in the order of `places`, which lists each place in the hit buffer once. Uses only this
/// thread and one shadow cache, so all counts of the cache depend on the order.
WhittedPicture whitted_picture_along(std::span<const std::size_t> places, const Whitted& tracer,
                                     const accel::PrimaryRays& rays, const accel::HitBuffer& hits,
                                     const PictureWatch& watch = {});

/// Draws the same picture into `image`, which must have its size, on this thread only; returns its
/// census.
RayCensus draw_in_order(const Whitted& tracer, const accel::PrimaryRays& rays,
                        const accel::HitBuffer& hits, Image& image);

/// The order of samples, which determines the contents of a shadow cache.
enum class ShadingOrder {
  kRows,  ///< row by row, with a new cache in each; rows may be shared among threads
  kScan,  ///< pixel by pixel along the rows, with one cache
  kBeams  ///< beam by beam, with one cache; the thesis expects this to help (6.2.2)
};

/// Parses `rows`, `scan` or `beams`. Throws InputError for any other name.
ShadingOrder parse_shading_order(std::string_view name);

/// Returns the places in the hit buffer of all samples along the rows.
std::vector<std::size_t> scan_order(const accel::PrimaryRays& rays);

/// Returns the same places in the order of beams: the places of each beam together, along the rows;
/// then the places in no beam that ends at an occupied leaf. Throws InputError for a structure that
/// does not trace beams.
std::vector<std::size_t> beam_order(const accel::Accelerator& structure,
                                    const accel::PrimaryRays& rays);

}  // namespace beambench::render

#pragma once
// A structure's work as a picture: one counter for each pixel.

#include <string>

#include "accel/core/accelerator.hpp"
#include "harness/base/progress.hpp"
#include "harness/render/picture/heat_map.hpp"

namespace beambench::cli {

/// Asks each ray for its closest hit, counting; a pixel's value is the mean of its samples. Hits go
/// to `hits`. Throws InputError listing the counters that the structure kept when `counter` is none
/// of them.
render::HeatMap count_work(const accel::Accelerator& accelerator, const accel::PrimaryRays& rays,
                           const std::string& counter, accel::HitBuffer& hits,
                           base::Progress& progress);

}  // namespace beambench::cli

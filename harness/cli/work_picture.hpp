#pragma once
// A structure's work as a picture: one counter for each pixel.

#include <string>

#include "accel/accelerator.hpp"
#include "harness/picture/heat_map.hpp"
#include "harness/progress/progress.hpp"

namespace beambench {

/// Asks each ray for its closest hit, counting; a pixel's value is the mean of its samples. Hits go
/// to `hits`. Throws InputError listing the counters that the structure kept when `counter` is none
/// of them.
HeatMap count_work(const Accelerator& accelerator, const PrimaryRays& rays,
                   const std::string& counter, HitBuffer& hits, Progress& progress);

}  // namespace beambench

#pragma once
// Tracing an image while the user watches.

#include "accel/accelerator.hpp"
#include "harness/progress/progress.hpp"

namespace beambench {

/// `accelerator.trace(rays, hits)`; on a terminal with the remaining time, estimated from a few
/// rays asked beforehand.
void watched_trace(const Accelerator& accelerator, const PrimaryRays& rays, HitBuffer& hits,
                   Progress& progress);

}  // namespace beambench

#pragma once
// An image traced on several threads.

#include <functional>

#include "accel/core/accelerator.hpp"

namespace beambench::accel {

/// The number of threads that `requested` stands for: one for each core where it is 0.
int thread_count(int requested);

/// Traces an image on a number of threads (`thread_count`), which may exceed the number of cores;
/// but while an Embree device exists, TBB allows no more than that device's threads
/// (`Workload::threads`) and no more than there are cores. Hits and counters do not depend on the
/// number, except for counters of time. The threads compute in the calling thread's floating-point
/// mode. `counters` may be null.
void trace_on(int threads, const Accelerator& structure, const PrimaryRays& rays, HitBuffer& buffer,
              WorkCounters* counters);

/// Calls `work(begin, end)` for ranges that together are [0, rows), on the threads of the TBB arena
/// that calls this. The ranges and their order are not determined.
void share_rows(int rows, const std::function<void(int begin, int end)>& work);

}  // namespace beambench::accel

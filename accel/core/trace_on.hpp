#pragma once
// An image on several threads.

#include "accel/core/accelerator.hpp"

namespace beambench::accel {

/// As many threads as there are cores where 0 are asked for, else as many as asked for.
int thread_count(int asked);

/// Traces an image on a number of threads (`thread_count`), which may be more than there are cores;
/// but TBB gives no more than Embree's living devices allow (`Workload::threads`), nor then more
/// than there are cores. Hits and counters do not depend on it, but for counters of time. The
/// threads compute in the calling thread's floating-point mode.
void trace_on(int threads, const Accelerator& structure, const PrimaryRays& rays,
              HitBuffer& buffer);
void trace_on(int threads, const Accelerator& structure, const PrimaryRays& rays, HitBuffer& buffer,
              WorkCounters& counters);

}  // namespace beambench::accel

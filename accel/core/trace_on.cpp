#include "accel/core/trace_on.hpp"

#include <algorithm>

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

namespace beambench::accel {
namespace {

/// `counters` is empty or a WorkCounters.
template <class... Counters>
void trace_with(int threads, const Accelerator& structure, const PrimaryRays& rays,
                HitBuffer& buffer, Counters&... counters) {
  const int count = thread_count(threads);
  if (count == 1) return structure.trace(rays, buffer, counters...);
  const auto allowed =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism,
                                  std::max(allowed, static_cast<std::size_t>(count)));
  // A new arena takes over the floating-point mode of the thread that makes it.
  tbb::task_arena arena(count);
  arena.execute([&] { structure.trace_shared(rays, buffer, counters...); });
}

}  // namespace

int thread_count(int asked) { return asked == 0 ? tbb::info::default_concurrency() : asked; }

void trace_on(int threads, const Accelerator& structure, const PrimaryRays& rays,
              HitBuffer& buffer) {
  trace_with(threads, structure, rays, buffer);
}

void trace_on(int threads, const Accelerator& structure, const PrimaryRays& rays, HitBuffer& buffer,
              WorkCounters& counters) {
  trace_with(threads, structure, rays, buffer, counters);
}

}  // namespace beambench::accel

#include "accel/core/trace_on.hpp"

#include <algorithm>
#include <mutex>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace beambench::accel {

int thread_count(int requested) {
  return requested == 0 ? tbb::info::default_concurrency() : requested;
}

void trace_on(int threads, const Accelerator& structure, const PrimaryRays& rays, HitBuffer& buffer,
              WorkCounters* counters) {
  const int count = thread_count(threads);
  if (count == 1) return structure.trace(rays, buffer, counters);
  const auto allowed =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism,
                                  std::max(allowed, static_cast<std::size_t>(count)));
  // A new arena takes over the floating-point mode of the thread that creates it.
  tbb::task_arena arena(count);
  arena.execute([&] { structure.trace_shared(rays, buffer, counters); });
}

void share_rows(int rows, const std::function<void(int begin, int end)>& work) {
  tbb::parallel_for(tbb::blocked_range(0, rows),
                    [&](const auto& range) { work(range.begin(), range.end()); });
}

void Accelerator::trace_shared(const PrimaryRays& rays, HitBuffer& buffer,
                               WorkCounters* counters) const {
  std::mutex adding;
  share_rows(rays.height(), [&](int begin, int end) {
    WorkCounters own;
    rays.for_each(begin, end, [&](std::size_t index, const Ray& ray) {
      buffer.set(index, closest_hit(ray, counters == nullptr ? nullptr : &own));
    });
    if (counters == nullptr) return;
    const std::lock_guard lock(adding);
    counters->add(own);
  });
}

}  // namespace beambench::accel

#include "accel/core/trace_on.hpp"

#include <algorithm>
#include <mutex>
#include <optional>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "scenes/core/cpu_quota.hpp"

namespace beambench::accel {

int thread_count(int requested) {
  static const std::optional<double> quota = cpu_quota();
  return requested == 0 ? threads_within(tbb::info::default_concurrency(), quota) : requested;
}

void on_threads(int threads, const std::function<void()>& work) {
  const int count = thread_count(threads);
  const auto allowed =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism,
                                  std::max(allowed, static_cast<std::size_t>(count)));
  // A new arena takes over the floating-point mode of the thread that creates it.
  tbb::task_arena arena(count);
  arena.execute(work);
}

void on_default_threads(const std::function<void()>& work) {
  const int count = thread_count(0);
  if (count >= tbb::info::default_concurrency()) return work();
  // Not a global_control: of several the least counts, so that no work could request more.
  tbb::task_arena arena(count);
  arena.execute(work);
}

void trace_on(int threads, const Accelerator& structure, const PrimaryRays& rays, HitBuffer& buffer,
              WorkCounters* counters) {
  const int count = thread_count(threads);
  if (count == 1) return structure.trace(rays, buffer, counters);
  on_threads(count, [&] { structure.trace_shared(rays, buffer, counters); });
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

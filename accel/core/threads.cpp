#include "accel/core/threads.hpp"

#include <algorithm>
#include <optional>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "scenes/base/cpu_quota.hpp"

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
  // A new arena inherits the floating-point mode of the thread that creates it.
  tbb::task_arena arena(count);
  arena.execute(work);
}

void on_default_threads(const std::function<void()>& work) {
  const int count = thread_count(0);
  if (count >= tbb::info::default_concurrency()) return work();
  // Not a global_control: of several, the lowest limit applies, so `work` could not request more
  // threads.
  tbb::task_arena arena(count);
  arena.execute(work);
}

void share_rows(int rows, const std::function<void(int begin, int end)>& work) {
  tbb::parallel_for(tbb::blocked_range(0, rows),
                    [&](const auto& range) { work(range.begin(), range.end()); });
}

}  // namespace beambench::accel

#pragma once
// The default number of threads, and work shared among several.

#include <functional>
#include <mutex>

#include "accel/core/accelerator.hpp"

namespace beambench::accel {

/// Returns the number of threads for `requested`. 0 requests the default: one thread for each core
/// that the process may use, but no more than its CPU quota keeps busy (`threads_within`).
int thread_count(int requested);

/// Runs `work` in a TBB arena of that many threads (`thread_count`), which may exceed the number of
/// cores. While an Embree device exists, however, TBB allows no more threads than that device has
/// (`Workload::threads`) and no more threads than there are cores. The threads compute in the
/// calling thread's floating-point mode.
void on_threads(int threads, const std::function<void()>& work);

/// Runs `work`, sharing its TBB tasks among the default number of threads unless it requests
/// another number. Without a CPU quota, TBB does this anyway.
void on_default_threads(const std::function<void()>& work);

/// Calls `work(begin, end)` for ranges that together are [0, rows), on the threads of the calling
/// TBB arena. The ranges and their order are unspecified.
void share_rows(int rows, const std::function<void(int begin, int end)>& work);

/// Calls `work(begin, end, counting)` for ranges that together are [0, rows): one range on the
/// calling thread, or several `on_threads`. `counting` is the policy for the context's counters
/// (`with_counting`).
template <class Work>
void for_rows(const QueryContext& context, int rows, const Work& work) {
  with_counting(context.counters, [&]<class Counting>(Counting& counting) {
    if (thread_count(context.threads) == 1) return work(0, rows, counting);
    std::mutex adding;
    on_threads(context.threads, [&] {
      share_rows(rows, [&](int begin, int end) {
        Counting own;
        work(begin, end, own);
        const std::lock_guard lock(adding);
        counting.add(own);
      });
    });
  });
}

}  // namespace beambench::accel

#pragma once
// Wall and CPU time of a piece of work.

#include <chrono>
#include <ctime>
#include <functional>
#include <utility>

namespace beambench {

struct PhaseTime {
  double wall_ms;
  double cpu_ms;  ///< of this thread
};

/// CPU time of the calling thread so far.
inline std::chrono::nanoseconds thread_cpu_time() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

/// Times `work`. The wall clock is read innermost: reading the CPU clock is a system call.
template <class Work>
PhaseTime time_phase(Work&& work) {
  const auto cpu_begin = thread_cpu_time();
  const auto begin = std::chrono::steady_clock::now();
  std::invoke(std::forward<Work>(work));
  const auto end = std::chrono::steady_clock::now();
  const auto cpu_end = thread_cpu_time();
  using Milliseconds = std::chrono::duration<double, std::milli>;
  return {Milliseconds(end - begin).count(), Milliseconds(cpu_end - cpu_begin).count()};
}

}  // namespace beambench

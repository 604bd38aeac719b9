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
inline double thread_cpu_ms() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Times `work`. The wall clock is read innermost: reading the CPU clock is a system call.
template <class Work>
PhaseTime time_phase(Work&& work) {
  const double cpu_begin = thread_cpu_ms();
  const auto begin = std::chrono::steady_clock::now();
  std::invoke(std::forward<Work>(work));
  const auto end = std::chrono::steady_clock::now();
  const double cpu_end = thread_cpu_ms();
  return {std::chrono::duration<double, std::milli>(end - begin).count(), cpu_end - cpu_begin};
}

}  // namespace beambench

#pragma once
// Wall and CPU time of a piece of work.

#include <chrono>
#include <ctime>
#include <functional>
#include <utility>

namespace beambench::bench {

struct PhaseTime {
  double wall_ms;
  double cpu_ms;  ///< of this thread, or of all
};

/// The clock of the CPU time that work on so many threads takes: the calling thread's, or that of
/// all threads of the process.
inline clockid_t cpu_clock(int threads) {
  return threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_PROCESS_CPUTIME_ID;
}

inline std::chrono::nanoseconds cpu_time(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

/// CPU time of the calling thread so far.
inline std::chrono::nanoseconds thread_cpu_time() { return cpu_time(CLOCK_THREAD_CPUTIME_ID); }

/// Times `work`. The wall clock is read innermost: reading the CPU clock is a system call.
template <class Work>
PhaseTime time_phase(Work&& work, clockid_t clock = CLOCK_THREAD_CPUTIME_ID) {
  const auto cpu_begin = cpu_time(clock);
  const auto begin = std::chrono::steady_clock::now();
  std::invoke(std::forward<Work>(work));
  const auto end = std::chrono::steady_clock::now();
  const auto cpu_end = cpu_time(clock);
  using Milliseconds = std::chrono::duration<double, std::milli>;
  return {Milliseconds(end - begin).count(), Milliseconds(cpu_end - cpu_begin).count()};
}

}  // namespace beambench::bench

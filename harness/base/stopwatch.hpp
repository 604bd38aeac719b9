#pragma once
// Measures the wall time and CPU time of a piece of work.

#include <chrono>
#include <ctime>

namespace beambench::base {

/// Wall time since construction, on the monotonic clock.
class Stopwatch {
 public:
  double seconds() const { return elapsed<std::chrono::duration<double>>(); }
  double milliseconds() const { return elapsed<std::chrono::duration<double, std::milli>>(); }

 private:
  template <class Duration>
  double elapsed() const {
    return Duration(std::chrono::steady_clock::now() - begin_).count();
  }

  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// CPU time since construction: of the calling thread or, if `clock` is CLOCK_PROCESS_CPUTIME_ID,
/// of all threads of the process. Reading it is a system call.
class CpuStopwatch {
 public:
  explicit CpuStopwatch(clockid_t clock = CLOCK_THREAD_CPUTIME_ID) : clock_(clock) {}
  double seconds() const { return std::chrono::duration<double>(now() - begin_).count(); }
  double milliseconds() const {
    return std::chrono::duration<double, std::milli>(now() - begin_).count();
  }

 private:
  std::chrono::nanoseconds now() const {
    timespec time{};
    ::clock_gettime(clock_, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
  }

  clockid_t clock_;
  std::chrono::nanoseconds begin_ = now();
};

}  // namespace beambench::base

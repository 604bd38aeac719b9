#pragma once
// The processor time of a piece of work: what it costs, whatever else the machine does.

#include <chrono>

#include "harness/bench/measurement.hpp"

namespace beambench::cluster {

/// CPU time of this thread since the timer was made.
class CpuTimer {
 public:
  double seconds() const {
    return std::chrono::duration<double>(bench::thread_cpu_time() - begin_).count();
  }

 private:
  std::chrono::nanoseconds begin_ = bench::thread_cpu_time();
};

}  // namespace beambench::cluster

#pragma once
// The conditions that timed code runs under, equal for every contender.

#include <sched.h>

namespace beambench::bench {

/// Sets the processor's floating-point mode while it lives: round to nearest, no traps, denormals
/// flushed to zero and read as zero (MXCSR's FTZ and DAZ), as Embree asks for. Everything is judged
/// outside of it.
class MeasuringFloatMode {
 public:
  MeasuringFloatMode();
  ~MeasuringFloatMode();
  MeasuringFloatMode(const MeasuringFloatMode&) = delete;
  MeasuringFloatMode& operator=(const MeasuringFloatMode&) = delete;

  /// Does this processor have such a mode that we know how to set?
  static bool available();
  /// Its MXCSR; 0 where there is none.
  static unsigned control_word();

 private:
  unsigned previous_;
};

/// The core that the calling thread is on, or -1 where the system does not tell.
int present_core();

/// Pins the calling thread to a core while it lives, where the system allows that (and `core` is
/// not -1). Threads started meanwhile inherit the pin, so wide work belongs outside of it.
class PinnedThread {
 public:
  explicit PinnedThread(int core);
  ~PinnedThread();
  PinnedThread(const PinnedThread&) = delete;
  PinnedThread& operator=(const PinnedThread&) = delete;

  bool pinned() const { return pinned_; }

 private:
  cpu_set_t previous_;
  bool pinned_ = false;
};

}  // namespace beambench::bench

#pragma once
// Runs and measures timed code, under the same conditions and with the same instruments for every
// contender.

#include <array>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <linux/perf_event.h>
#include <sched.h>

#include "harness/base/stopwatch.hpp"
#include "harness/measure/record/cell_record.hpp"

namespace beambench::measure {

/// Sets the processor's floating-point mode while it lives: round to nearest, no traps, denormals
/// flushed to zero and read as zero (on x86, FTZ and DAZ of MXCSR), as Embree requires. Hits are
/// verified outside of it.
class MeasuringFloatMode {
 public:
  MeasuringFloatMode();
  ~MeasuringFloatMode();
  MeasuringFloatMode(const MeasuringFloatMode&) = delete;
  MeasuringFloatMode& operator=(const MeasuringFloatMode&) = delete;

  /// Returns whether this processor has such a mode and the program can set it.
  static bool available();
  /// Returns the control word in that mode (accel/core/float_mode.hpp); 0 where it is not known.
  static unsigned control_word();

 private:
  unsigned previous_;
};

/// Returns the core that the calling thread is on, or -1 where the system does not report it.
int present_core();

/// Pins the calling thread to a core while it lives, where the system allows that (and `core` is
/// not -1). Threads started meanwhile inherit the pin, so parallel work belongs outside of it.
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

struct PhaseTime {
  double wall_ms;
  double cpu_ms;  ///< of this thread, or of all
};

/// Returns the clock of the CPU time of work on that many threads.
inline clockid_t cpu_clock(int threads) {
  return threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_PROCESS_CPUTIME_ID;
}

/// Times `work`. The wall clock is read innermost: reading the CPU clock is a system call.
template <class Work>
PhaseTime time_phase(Work&& work, clockid_t clock = CLOCK_THREAD_CPUTIME_ID) {
  const base::CpuStopwatch cpu(clock);
  const base::Stopwatch wall;
  std::invoke(std::forward<Work>(work));
  const double wall_ms = wall.milliseconds();
  return {wall_ms, cpu.milliseconds()};
}

/// Returns the rate of the core's clock in GHz: from the time of a chain of dependent integer
/// multiplications, three cycles each on the x86 processors of the last fifteen years (Fog,
/// Instruction tables); elsewhere it is off by a constant factor. Uses the fastest of a few slices,
/// some 30 us in all: an interrupt makes a slice longer, nothing makes one shorter.
double clock_ghz();

/// Returns the bytes in use in the whole heap, including headers and rounding, by glibc's
/// mallinfo2; nothing where the allocator does not report it. Memory that a library maps past the
/// allocator is not included.
std::optional<std::uint64_t> heap_in_use();

/// Returns the growth between two readings; 0 when it shrank, nothing when one is missing.
std::optional<std::uint64_t> heap_growth(std::optional<std::uint64_t> before,
                                         std::optional<std::uint64_t> after);

/// Keeps the calling core busy, so that its clock and caches leave their idle state before the
/// first repetition, and times slices of equal work meanwhile. Returns the noise of the second
/// half; nothing when the time was too short.
std::optional<double> warm_up(std::chrono::duration<double> duration);

/// Returns the additional time of the slowest twentieth over the median slice, as a part of the
/// median: equal work takes longer only because of others (interrupts, other tenants, the clock).
/// Nothing for fewer than 40 slices.
std::optional<double> noise(std::span<const double> slices);

/// Returns the time of a trace that costs a structure nothing: the median of several in
/// milliseconds, after one that is not timed. `core` is to pin to; -1: any.
double harness_ms(int core, const std::function<void()>& trace);

/// Opens an event of the calling thread: a file descriptor, or -1 and errno (perf_event_open(2)).
using OpenEvent = std::function<int(const perf_event_attr&)>;
int open_perf_event(const perf_event_attr& attributes);

/// Counters of the thread that made it, in user mode. They run all the time and are read before and
/// after a phase, so that reading them is outside of what is timed.
class HardwareCounters {
 public:
  explicit HardwareCounters(const OpenEvent& open = open_perf_event);
  ~HardwareCounters();
  HardwareCounters(const HardwareCounters&) = delete;
  HardwareCounters& operator=(const HardwareCounters&) = delete;

  /// Returns why an event is not counted, in a sentence; empty when all are counted.
  const std::string& problem() const { return problem_; }

  /// Runs `work` and returns the counts during it.
  HardwareCounts count(const std::function<void()>& work) const;

 private:
  /// The state of an event: its count, and for how long it was enabled and running (the system lets
  /// events take turns when there are too few counters).
  struct Reading {
    std::uint64_t value;
    std::uint64_t enabled_ns;
    std::uint64_t running_ns;
  };
  using Readings = std::array<std::optional<Reading>, kHardwareEvents.size()>;

  Readings read() const;
  static std::optional<std::uint64_t> difference(const std::optional<Reading>& before,
                                                 const std::optional<Reading>& after);

  std::array<int, kHardwareEvents.size()> descriptors_;
  std::string problem_;
};

}  // namespace beambench::measure

#pragma once
// Runs and measures timed code, with the same conditions and instruments for every contender.

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

/// Sets the processor's floating-point mode during its lifetime: round to nearest, no traps,
/// denormals flushed to zero and read as zero (on x86, FTZ and DAZ of MXCSR), as Embree requires.
/// Hits are verified outside this mode.
class MeasuringFloatMode {
 public:
  MeasuringFloatMode();
  ~MeasuringFloatMode();
  MeasuringFloatMode(const MeasuringFloatMode&) = delete;
  MeasuringFloatMode& operator=(const MeasuringFloatMode&) = delete;

  /// Returns whether this processor has such a mode and the program can set it.
  static bool available();
  /// Returns the control word in that mode (accel/core/float_mode.hpp); 0 if it is unknown.
  static unsigned control_word();

 private:
  unsigned previous_;
};

/// Returns the core on which the calling thread runs; -1 if the system does not report it.
int present_core();

/// Pins the calling thread to a core during its lifetime, if the system allows it and `core` is not
/// -1. Threads started meanwhile inherit the pin, so do parallel work outside it.
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
  double cpu_ms;  ///< of this thread, or of all threads
};

/// Returns the clock that measures the CPU time of work on that many threads.
inline clockid_t cpu_clock(int threads) {
  return threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_PROCESS_CPUTIME_ID;
}

/// Times `work`. The wall clock is read last before the work and first after it, because reading
/// the CPU clock is a system call.
template <class Work>
PhaseTime time_phase(Work&& work, clockid_t clock = CLOCK_THREAD_CPUTIME_ID) {
  const base::CpuStopwatch cpu(clock);
  const base::Stopwatch wall;
  std::invoke(std::forward<Work>(work));
  const double wall_ms = wall.milliseconds();
  return {wall_ms, cpu.milliseconds()};
}

/// Returns the clock rate of the core in GHz, from the time of a chain of dependent integer
/// multiplications. They take three cycles each on the x86 processors of the last fifteen years
/// (Fog, Instruction tables); on others the result is off by a constant factor. Uses the fastest of
/// a few slices, about 30 us in total: interrupts can make a slice longer, but nothing makes it
/// shorter.
double clock_ghz();

/// Returns the bytes in use in the whole heap, including headers and rounding, by glibc's
/// mallinfo2; nothing if the allocator does not report it. Excludes memory that a library maps
/// without the allocator.
std::optional<std::uint64_t> heap_in_use();

/// Returns the growth between two readings; 0 if the heap shrank, nothing if a reading is missing.
std::optional<std::uint64_t> heap_growth(std::optional<std::uint64_t> before,
                                         std::optional<std::uint64_t> after);

/// Keeps the calling core busy, so that its clock and caches leave their idle state before the
/// first repetition, and meanwhile times slices of equal work. Returns the noise of the second
/// half; nothing if the duration was too short.
std::optional<double> warm_up(std::chrono::duration<double> duration);

/// Returns the time by which the slowest 5% of the slices exceed the median slice, as a fraction of
/// the median: equal work takes longer only because of external causes (interrupts, other tenants,
/// the clock). Returns nothing for fewer than 40 slices.
std::optional<double> noise(std::span<const double> slices);

/// Returns the wall time in milliseconds of the fastest of several runs of `work`.
double least_ms(int times, const std::function<void()>& work);

/// Returns the time in milliseconds of a trace that costs a structure nothing: the fastest of
/// several traces, after one that is not timed. It is subtracted from times of blocks, which are
/// those of their fastest repetition, too. `core` is the core to pin to; -1: any.
double harness_ms(int core, const std::function<void()>& trace);

/// Opens an event of the calling thread. Returns a file descriptor, or -1 with errno set
/// (perf_event_open(2)).
using OpenEvent = std::function<int(const perf_event_attr&)>;
int open_perf_event(const perf_event_attr& attributes);

/// Hardware counters of the constructing thread, in user mode. The counters always run and are read
/// before and after a phase, so the times do not include reading them.
class HardwareCounters {
 public:
  explicit HardwareCounters(const OpenEvent& open = open_perf_event);
  ~HardwareCounters();
  HardwareCounters(const HardwareCounters&) = delete;
  HardwareCounters& operator=(const HardwareCounters&) = delete;

  /// Returns why an event is not counted, as a sentence; empty if all are counted.
  const std::string& problem() const { return problem_; }

  /// Runs `work` and returns the counts made during it.
  HardwareCounts count(const std::function<void()>& work) const;

 private:
  /// The state of an event: its count, and for how long it was enabled and running (the system lets
  /// events take turns if there are too few counters).
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

#pragma once
// How timed code is run and measured: its conditions, equal for every contender, and its
// instruments.

#include <chrono>
#include <cstdint>
#include <ctime>
#include <functional>
#include <optional>
#include <span>
#include <utility>

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

/// The rate of the core's clock in GHz: from the time of a chain of dependent integer
/// multiplications, three cycles each on the x86 processors of the last fifteen years (Fog,
/// Instruction tables); elsewhere it is right but for a constant factor. The fastest of a few
/// slices, some 30 us in all: an interrupt makes a slice longer, nothing makes one shorter.
double clock_ghz();

/// Bytes in use in all of the heap, headers and rounding included, by glibc's mallinfo2; nothing
/// where the allocator does not tell. Memory that a library maps past the allocator is not in it.
std::optional<std::uint64_t> heap_in_use();

/// By how much it grew from one asking to the other; 0 when it shrank, nothing when one is missing.
std::optional<std::uint64_t> heap_growth(std::optional<std::uint64_t> before,
                                         std::optional<std::uint64_t> after);

/// Keeps the calling core busy, so that its clock and caches leave their idle state before the
/// first repetition, and times slices of equal work meanwhile. Returns the noise of the second
/// half; nothing when the time was too short to tell.
std::optional<double> warm_up(std::chrono::duration<double> duration);

/// How much longer than the median slice the slowest twentieth took, as a part of the median: work
/// that never changes takes longer only because of others (interrupts, other tenants, the clock).
/// Nothing for fewer than 40 slices.
std::optional<double> noise(std::span<const double> slices);

/// What a trace takes that costs a structure nothing: the median of several in milliseconds, after
/// one that is not timed. `core` is to pin to; -1: any.
double harness_ms(int core, const std::function<void()>& trace);

}  // namespace beambench::bench

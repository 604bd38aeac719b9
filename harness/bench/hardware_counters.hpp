#pragma once
// The processor's own counters, where the system lets us read them.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include <linux/perf_event.h>

#include "harness/bench/record/cell_record.hpp"

namespace beambench::bench {

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

  /// Why an event is not counted, in a sentence; empty when all are.
  const std::string& problem() const { return problem_; }

  /// Runs `work` and returns what was counted meanwhile.
  HardwareCounts count(const std::function<void()>& work) const;

 private:
  /// As read from an event: its count, and for how long it was enabled and running (the system lets
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

}  // namespace beambench::bench

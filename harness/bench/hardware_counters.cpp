#include "harness/bench/hardware_counters.hpp"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace beambench::bench {
namespace {

// In the order of kHardwareEvents.
constexpr std::array<std::uint64_t, kHardwareEvents.size()> kConfigs{
    PERF_COUNT_HW_INSTRUCTIONS, PERF_COUNT_HW_CPU_CYCLES, PERF_COUNT_HW_CACHE_MISSES};

perf_event_attr attributes_of(std::uint64_t config) {
  perf_event_attr attributes{};
  attributes.type = PERF_TYPE_HARDWARE;
  attributes.size = sizeof(attributes);
  attributes.config = config;
  attributes.exclude_kernel = 1;  // also what unprivileged users may count
  attributes.exclude_hv = 1;
  attributes.read_format = PERF_FORMAT_TOTAL_TIME_ENABLED | PERF_FORMAT_TOTAL_TIME_RUNNING;
  return attributes;
}

std::string reason(int error) {
  if (error == ENOENT || error == EOPNOTSUPP || error == ENODEV) {
    return "this machine has no such counter (virtual ones often do not)";
  }
  if (error == EACCES || error == EPERM) {
    return "the system forbids it (see /proc/sys/kernel/perf_event_paranoid)";
  }
  return std::strerror(error);
}

}  // namespace

int open_perf_event(const perf_event_attr& attributes) {
  constexpr int kThisThread = 0;
  constexpr int kAnyCore = -1;
  constexpr int kNoGroup = -1;
  return static_cast<int>(::syscall(SYS_perf_event_open, &attributes, kThisThread, kAnyCore,
                                    kNoGroup, PERF_FLAG_FD_CLOEXEC));
}

HardwareCounters::HardwareCounters(const OpenEvent& open) {
  for (std::size_t i = 0; i < kConfigs.size(); ++i) {
    descriptors_[i] = open(attributes_of(kConfigs[i]));
    if (descriptors_[i] >= 0 || !problem_.empty()) continue;
    problem_ =
        fmt::format("The processor's {} were not counted: {}.", kHardwareEvents[i], reason(errno));
  }
}

HardwareCounters::~HardwareCounters() {
  for (const int descriptor : descriptors_) {
    if (descriptor >= 0) ::close(descriptor);
  }
}

HardwareCounts HardwareCounters::count(const std::function<void()>& work) const {
  const Readings before = read();
  work();
  const Readings after = read();
  HardwareCounts counts;
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = difference(before[i], after[i]);
  return counts;
}

HardwareCounters::Readings HardwareCounters::read() const {
  Readings readings;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    Reading reading{};
    if (descriptors_[i] < 0) continue;
    if (::read(descriptors_[i], &reading, sizeof(reading)) == sizeof(reading)) {
      readings[i] = reading;
    }
  }
  return readings;
}

std::optional<std::uint64_t> HardwareCounters::difference(const std::optional<Reading>& before,
                                                          const std::optional<Reading>& after) {
  if (!before || !after) return std::nullopt;
  const std::uint64_t running = after->running_ns - before->running_ns;
  if (running == 0) return std::nullopt;  // it had no turn
  const std::uint64_t enabled = after->enabled_ns - before->enabled_ns;
  const std::uint64_t value = after->value - before->value;
  if (running >= enabled) return value;
  return static_cast<std::uint64_t>(static_cast<double>(value) * static_cast<double>(enabled) /
                                    static_cast<double>(running));
}

}  // namespace beambench::bench

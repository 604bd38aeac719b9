#include "harness/measure/measurement.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <malloc.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "accel/core/float_mode.hpp"
#include "harness/measure/record/robust_statistics.hpp"

#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 33)
#define BEAMBENCH_HAS_MALLINFO2 1
#else
#define BEAMBENCH_HAS_MALLINFO2 0
#endif

namespace beambench::measure {
namespace {

constexpr unsigned kMeasuringMode = accel::kInitialFloatMode | accel::kFlushSubnormals;

constexpr int kMultiplications = 8000;

/// Multiplies repeatedly. Each factor is the previous product, so no two multiplications can
/// overlap.
std::uint64_t chain(std::uint64_t value) {
  for (int i = 0; i < kMultiplications; ++i) {
    value *= value;
    asm volatile("" : "+r"(value));  // keeps the compiler from shortening the chain
  }
  return value;
}

constexpr std::size_t kMinSlices = 40;
// A chain of multiplications and additions, each of which waits for the previous one, takes about
// 0.2 ms.
constexpr int kStepsOfASlice = 50'000;

double slice_ms() {
  const base::Stopwatch watch;
  volatile double result = 0.0;
  double value = 1.0;
  for (int i = 0; i < kStepsOfASlice; ++i) value = value * 1.0000001 + 1e-9;
  result = value;
  static_cast<void>(result);
  return watch.milliseconds();
}

// In the order of kHardwareEvents.
constexpr std::array<std::uint64_t, kHardwareEvents.size()> kConfigs{
    PERF_COUNT_HW_INSTRUCTIONS, PERF_COUNT_HW_CPU_CYCLES, PERF_COUNT_HW_CACHE_MISSES};

perf_event_attr attributes_of(std::uint64_t config) {
  perf_event_attr attributes{};
  attributes.type = PERF_TYPE_HARDWARE;
  attributes.size = sizeof(attributes);
  attributes.config = config;
  attributes.exclude_kernel = 1;  // so that unprivileged users may count, too
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

MeasuringFloatMode::MeasuringFloatMode() : previous_(accel::float_mode()) {
  accel::set_float_mode(kMeasuringMode);
}
MeasuringFloatMode::~MeasuringFloatMode() { accel::set_float_mode(previous_); }
bool MeasuringFloatMode::available() { return accel::kFlushSubnormals != 0; }
unsigned MeasuringFloatMode::control_word() { return kMeasuringMode; }

int present_core() { return ::sched_getcpu(); }

PinnedThread::PinnedThread(int core) {
  CPU_ZERO(&previous_);
  if (core < 0 || ::sched_getaffinity(0, sizeof(previous_), &previous_) != 0) return;
  cpu_set_t only;
  CPU_ZERO(&only);
  CPU_SET(static_cast<std::size_t>(core), &only);
  pinned_ = ::sched_setaffinity(0, sizeof(only), &only) == 0;
}

PinnedThread::~PinnedThread() {
  if (pinned_) ::sched_setaffinity(0, sizeof(previous_), &previous_);
}

double clock_ghz() {
  constexpr int kSlices = 4;
  constexpr double kCyclesEach = 3.0;
  double fastest_ms = std::numeric_limits<double>::infinity();
  std::uint64_t value = 3;
  for (int slice = 0; slice < kSlices; ++slice) {
    const base::Stopwatch watch;
    value = chain(value | 1U);
    fastest_ms = std::min(fastest_ms, watch.milliseconds());
  }
  return 1e-6 * kCyclesEach * kMultiplications / fastest_ms;
}

std::optional<std::uint64_t> heap_in_use() {
#if BEAMBENCH_HAS_MALLINFO2
  const struct mallinfo2 info = ::mallinfo2();
  const std::uint64_t bytes =
      info.uordblks + info.hblkhd;  // in arenas, and mapped for large blocks
  if (bytes > 0) return bytes;      // replaced allocators (of sanitizers) report 0
#endif
  return std::nullopt;
}

std::optional<std::uint64_t> heap_growth(std::optional<std::uint64_t> before,
                                         std::optional<std::uint64_t> after) {
  if (!before || !after) return std::nullopt;
  return *after > *before ? *after - *before : 0;
}

std::optional<double> warm_up(std::chrono::duration<double> duration) {
  const base::Stopwatch watch;
  std::vector<double> slices;
  while (watch.seconds() < duration.count()) slices.push_back(slice_ms());
  return noise(std::span(slices).subspan(slices.size() / 2));
}

std::optional<double> noise(std::span<const double> slices) {
  if (slices.size() < kMinSlices) return std::nullopt;
  std::vector<double> sorted(slices.begin(), slices.end());
  std::sort(sorted.begin(), sorted.end());
  const double high = sorted[sorted.size() - 1 - sorted.size() / 20];
  const double middle = median(sorted);
  return middle > 0.0 ? (high - middle) / middle : 0.0;
}

double least_ms(int times, const std::function<void()>& work) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < times; ++i) least = std::min(least, time_phase(work).wall_ms);
  return least;
}

double harness_ms(int core, const std::function<void()>& trace) {
  constexpr int kTraces = 9;
  const PinnedThread pin(core);
  const MeasuringFloatMode mode;
  trace();
  return least_ms(kTraces, trace);
}

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
  if (running == 0) return std::nullopt;  // it was never scheduled
  const std::uint64_t enabled = after->enabled_ns - before->enabled_ns;
  const std::uint64_t value = after->value - before->value;
  if (running >= enabled) return value;
  return static_cast<std::uint64_t>(static_cast<double>(value) * static_cast<double>(enabled) /
                                    static_cast<double>(running));
}

}  // namespace beambench::measure

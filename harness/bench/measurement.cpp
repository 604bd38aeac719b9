#include "harness/bench/measurement.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

#include "harness/bench/record/robust_statistics.hpp"

#if defined(__SSE2__)
#include <immintrin.h>
#endif
#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 33)
#include <malloc.h>
#define BEAMBENCH_HAS_MALLINFO2 1
#else
#define BEAMBENCH_HAS_MALLINFO2 0
#endif

namespace beambench::bench {
namespace {

#if defined(__SSE2__)
constexpr bool kHasMxcsr = true;
// Power-on value (all exceptions masked, round to nearest) with FTZ (bit 15) and DAZ (bit 6).
constexpr unsigned kMeasuringMode = 0x1F80U | 0x8000U | 0x0040U;
unsigned read_mode() { return _mm_getcsr(); }
void write_mode(unsigned mode) { _mm_setcsr(mode); }
#else
constexpr bool kHasMxcsr = false;
constexpr unsigned kMeasuringMode = 0;
unsigned read_mode() { return 0; }
void write_mode(unsigned) {}
#endif

constexpr int kSlices = 4;
constexpr int kMultiplications = 8000;
constexpr double kCyclesEach = 3.0;

/// Each factor is the product before it: no two of them can run at once.
std::uint64_t chain(std::uint64_t value) {
  for (int i = 0; i < kMultiplications; ++i) {
    value *= value;
    asm volatile("" : "+r"(value));  // keeps the compiler from finding a shorter way
  }
  return value;
}

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMinSlices = 40;
// A chain of multiplications and additions, each waiting for the one before: some 0.2 ms.
constexpr int kStepsOfASlice = 50'000;

double slice_ms() {
  const auto begin = Clock::now();
  volatile double result = 0.0;
  double value = 1.0;
  for (int i = 0; i < kStepsOfASlice; ++i) value = value * 1.0000001 + 1e-9;
  result = value;
  static_cast<void>(result);
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

}  // namespace

MeasuringFloatMode::MeasuringFloatMode() : previous_(read_mode()) { write_mode(kMeasuringMode); }
MeasuringFloatMode::~MeasuringFloatMode() { write_mode(previous_); }
bool MeasuringFloatMode::available() { return kHasMxcsr; }
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
  double fastest_ns = std::numeric_limits<double>::infinity();
  std::uint64_t value = 3;
  for (int slice = 0; slice < kSlices; ++slice) {
    const auto begin = std::chrono::steady_clock::now();
    value = chain(value | 1U);
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - begin;
    fastest_ns = std::min(fastest_ns, taken.count());
  }
  return kCyclesEach * kMultiplications / fastest_ns;
}

std::optional<std::uint64_t> heap_in_use() {
#if BEAMBENCH_HAS_MALLINFO2
  const struct mallinfo2 info = ::mallinfo2();
  const std::uint64_t bytes =
      info.uordblks + info.hblkhd;  // in arenas, and mapped for large blocks
  if (bytes > 0) return bytes;      // a replaced allocator (a sanitizer's) says 0
#endif
  return std::nullopt;
}

std::optional<std::uint64_t> heap_growth(std::optional<std::uint64_t> before,
                                         std::optional<std::uint64_t> after) {
  if (!before || !after) return std::nullopt;
  return *after > *before ? *after - *before : 0;
}

std::optional<double> warm_up(std::chrono::duration<double> duration) {
  const auto begin = Clock::now();
  std::vector<double> slices;
  while (Clock::now() - begin < duration) slices.push_back(slice_ms());
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

double harness_ms(int core, const std::function<void()>& trace) {
  constexpr int kTraces = 9;
  const PinnedThread pin(core);
  const MeasuringFloatMode mode;
  trace();
  std::vector<double> times;
  for (int i = 0; i < kTraces; ++i) times.push_back(time_phase(trace).wall_ms);
  return median(times);
}

}  // namespace beambench::bench

#include "harness/bench/conditions.hpp"

#if defined(__SSE2__)
#include <immintrin.h>
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

}  // namespace beambench::bench

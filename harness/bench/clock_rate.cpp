#include "harness/bench/clock_rate.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>

namespace beambench::bench {
namespace {

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

}  // namespace

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

}  // namespace beambench::bench

#pragma once
// Random numbers that are the same on every machine.

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace beambench {

/// A generator based on std::mt19937_64, whose sequence the C++ standard fixes, with our own
/// distributions (the standard library's distributions differ between implementations).
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  std::uint64_t bits() { return engine_(); }
  /// Returns a uniform number in [0, 1), a multiple of 2^-53.
  double unit() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
  /// Returns a uniform number in [low, high).
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  /// Returns a uniform integer in 0 ... count - 1 (count >= 1; bias below 2^-32 for 32-bit counts).
  std::uint64_t below(std::uint64_t count) {
    return static_cast<std::uint64_t>(unit() * static_cast<double>(count));
  }

 private:
  std::mt19937_64 engine_;
};

/// Shuffles by the Fisher-Yates algorithm.
template <class T>
void shuffle(std::vector<T>& values, Random& random) {
  for (std::size_t left = values.size(); left > 1; --left) {
    std::swap(values[left - 1], values[random.below(left)]);
  }
}

}  // namespace beambench

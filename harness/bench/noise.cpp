#include "harness/bench/noise.hpp"

#include <algorithm>
#include <vector>

#include "harness/bench/record/robust_statistics.hpp"

namespace beambench::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kLeastSlices = 40;
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

std::optional<double> warm_up(std::chrono::duration<double> duration) {
  const auto begin = Clock::now();
  std::vector<double> slices;
  while (Clock::now() - begin < duration) slices.push_back(slice_ms());
  return noise(std::span(slices).subspan(slices.size() / 2));
}

std::optional<double> noise(std::span<const double> slices) {
  if (slices.size() < kLeastSlices) return std::nullopt;
  std::vector<double> sorted(slices.begin(), slices.end());
  std::sort(sorted.begin(), sorted.end());
  const double high = sorted[sorted.size() - 1 - sorted.size() / 20];
  const double middle = median(sorted);
  return middle > 0.0 ? (high - middle) / middle : 0.0;
}

}  // namespace beambench::bench

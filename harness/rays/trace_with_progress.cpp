#include "harness/rays/trace_with_progress.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>

#include "accel/core/trace_on.hpp"
#include "harness/base/stopwatch.hpp"

namespace beambench::rays {
namespace {

constexpr double kProbeSeconds = 0.02;
constexpr int kProbeRays = 1000;
constexpr double kWorthWatching = 0.5;  // seconds

/// What all rays would take if they were like a few of them, spread over all.
double estimated_seconds(const accel::Accelerator& structure, const TraceInput& input) {
  const base::Stopwatch stopwatch;
  const auto rays = static_cast<double>(input.size());
  int traced = 0;
  while (traced < kProbeRays && stopwatch.seconds() < kProbeSeconds) {
    // Steps of the golden ratio never come back to where they were.
    const double at = traced * 0.6180339887498949;
    const auto index = static_cast<std::size_t>((at - std::floor(at)) * rays);
    structure.closest_hit(input.ray(index), nullptr);
    ++traced;
  }
  return stopwatch.seconds() / traced * rays;
}

}  // namespace

void trace_with_progress(const accel::Accelerator& structure, const TraceInput& input,
                         TraceResults& results, int threads, base::Progress& progress) {
  const double expected = progress.on_terminal()
                              ? estimated_seconds(structure, input) / accel::thread_count(threads)
                              : 0.0;
  if (expected < kWorthWatching) return trace(structure, input, results, nullptr, threads);
  const base::Stopwatch stopwatch;
  auto tracing =
      std::async(std::launch::async, [&] { trace(structure, input, results, nullptr, threads); });
  while (tracing.wait_for(std::chrono::milliseconds(100)) == std::future_status::timeout) {
    progress.advance(std::min(stopwatch.seconds() / expected, 0.99));
  }
  tracing.get();
}

}  // namespace beambench::rays

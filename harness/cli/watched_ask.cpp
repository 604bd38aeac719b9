#include "harness/cli/watched_ask.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>

#include "accel/core/trace_on.hpp"

namespace beambench::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kProbeSeconds = 0.02;
constexpr int kProbeRays = 1000;
constexpr double kWorthWatching = 0.5;  // seconds

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// What all rays would take if they were like a few of them, spread over the input.
double estimated_seconds(const accel::Accelerator& structure, const rays::TraceInput& input) {
  const Clock::time_point begin = Clock::now();
  const auto rays = static_cast<double>(input.size());
  int asked = 0;
  while (asked < kProbeRays && seconds_since(begin) < kProbeSeconds) {
    // Steps of the golden ratio never come back to where they were.
    const double at = asked * 0.6180339887498949;
    const auto index = static_cast<std::size_t>((at - std::floor(at)) * rays);
    structure.closest_hit(input.ray(index), nullptr);
    ++asked;
  }
  return seconds_since(begin) / asked * rays;
}

}  // namespace

void watched_ask(const accel::Accelerator& structure, const rays::TraceInput& input,
                 rays::TraceResults& results, int threads, base::Progress& progress) {
  const double expected = progress.on_terminal()
                              ? estimated_seconds(structure, input) / accel::thread_count(threads)
                              : 0.0;
  if (expected < kWorthWatching) return rays::trace(structure, input, results, nullptr, threads);
  const Clock::time_point begin = Clock::now();
  auto asked = std::async(std::launch::async,
                          [&] { rays::trace(structure, input, results, nullptr, threads); });
  while (asked.wait_for(std::chrono::milliseconds(100)) == std::future_status::timeout) {
    progress.advance(std::min(seconds_since(begin) / expected, 0.99));
  }
  asked.get();
}

}  // namespace beambench::cli

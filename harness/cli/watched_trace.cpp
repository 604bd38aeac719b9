#include "harness/cli/watched_trace.hpp"

#include <algorithm>
#include <chrono>
#include <future>

namespace beambench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kProbeSeconds = 0.02;
constexpr int kProbeRays = 1000;
constexpr double kWorthWatching = 0.5;  // seconds

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// What the image would take if all rays were like a few of them, spread over it.
double estimated_seconds(const Accelerator& accelerator, const PrimaryRays& rays) {
  const Clock::time_point begin = Clock::now();
  int asked = 0;
  while (asked < kProbeRays && seconds_since(begin) < kProbeSeconds) {
    const int x = static_cast<int>(asked * 0.618034 * rays.width()) % rays.width();
    const int y = static_cast<int>(asked * 0.754878 * rays.height()) % rays.height();
    accelerator.closest_hit(rays.ray(x, y, 0));
    ++asked;
  }
  return seconds_since(begin) / asked * static_cast<double>(rays.count());
}

}  // namespace

void watched_trace(const Accelerator& accelerator, const PrimaryRays& rays, HitBuffer& hits,
                   Progress& progress) {
  const double expected = progress.on_terminal() ? estimated_seconds(accelerator, rays) : 0.0;
  if (expected < kWorthWatching) {
    accelerator.trace(rays, hits);
    return;
  }
  const Clock::time_point begin = Clock::now();
  auto traced = std::async(std::launch::async, [&] { accelerator.trace(rays, hits); });
  while (traced.wait_for(std::chrono::milliseconds(100)) == std::future_status::timeout) {
    progress.advance(std::min(seconds_since(begin) / expected, 0.99));
  }
  traced.get();
}

}  // namespace beambench

#include "harness/rays/trace_results.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <limits>

#include <fmt/format.h>

#include "accel/core/threads.hpp"
#include "harness/base/stopwatch.hpp"

namespace beambench::rays {
namespace {

constexpr std::uint8_t kPoison = 0xFF;

constexpr double kProbeSeconds = 0.02;
constexpr int kProbeRays = 1000;
constexpr double kWorthWatching = 0.5;  // seconds

/// Estimates the time for all rays from a few of them, spread over all.
double estimated_seconds(const accel::Accelerator& structure, const TraceInput& input) {
  const base::Stopwatch stopwatch;
  const auto rays = static_cast<double>(input.size());
  int traced = 0;
  while (traced < kProbeRays && stopwatch.seconds() < kProbeSeconds) {
    // Steps of the golden ratio never revisit a place.
    const double at = traced * 0.6180339887498949;
    const auto index = static_cast<std::size_t>((at - std::floor(at)) * rays);
    structure.closest_hit(input.ray(index), nullptr);
    ++traced;
  }
  return stopwatch.seconds() / traced * rays;
}

}  // namespace

TraceResults make_results(const TraceInput& input) {
  if (input.query() == Query::kAnyHit) return AnyHits(input.size(), 0);
  if (const accel::PrimaryRays* image = input.image()) {
    return accel::HitBuffer(image->width(), image->height(), image->samples());
  }
  return accel::HitBuffer(static_cast<int>(input.size()), 1, 1);
}

void poison(TraceResults& results) {
  if (auto* any = std::get_if<AnyHits>(&results)) {
    std::ranges::fill(*any, kPoison);
  } else {
    poison(std::get<accel::HitBuffer>(results));
  }
}

void poison(accel::HitBuffer& hits) {
  std::fill_n(hits.t(), hits.size(), std::numeric_limits<float>::quiet_NaN());
  std::fill_n(hits.primitive(), hits.size(), scenes::kNoPrimitive - 1);
}

bool is_hit_at(const TraceResults& results, std::size_t index) {
  if (const auto* any = std::get_if<AnyHits>(&results)) return (*any)[index] != 0;
  return std::get<accel::HitBuffer>(results).get(index).has_value();
}

bool is_supported(const accel::StructureChoice& choice, const TraceInput& input) {
  const accel::Support& support = choice.info().support;
  return input.image() != nullptr ? support.images : support.batches;
}

void require_support(const accel::StructureChoice& choice, const TraceInput& input) {
  if (is_supported(choice, input)) return;
  throw accel::UnsupportedError(fmt::format("'{}' does not trace {}", choice.info().name,
                                            input.image() != nullptr ? "images" : "lists of rays"));
}

void trace(const accel::Accelerator& structure, const TraceInput& input, TraceResults& results,
           accel::WorkCounters* counters, int threads) {
  if (auto* any = std::get_if<AnyHits>(&results)) {
    structure.any_hits(input.list()->batch(), *any, {counters, threads});
  } else if (input.image() != nullptr) {
    structure.closest_hits(*input.image(), std::get<accel::HitBuffer>(results),
                           {counters, threads});
  } else {
    structure.closest_hits(input.list()->batch(), std::get<accel::HitBuffer>(results),
                           {counters, threads});
  }
}

std::optional<std::string> share_warning(const TraceInput& input, std::uint64_t hits) {
  constexpr double kMinShare = 0.01;
  const double share = static_cast<double>(hits) / static_cast<double>(input.size());
  if (share >= kMinShare && share <= 1.0 - kMinShare) return std::nullopt;
  return fmt::format("{} of the {} {} rays {} ({:.3g}%): {}", hits, input.size(), input.label(),
                     input.query() == Query::kAnyHit ? "are occluded" : "hit something",
                     100.0 * share,
                     share < kMinShare ? "times mostly compare how structures handle misses"
                                       : "hardly any ray misses");
}

void trace_with_progress(const accel::Accelerator& structure, const TraceInput& input,
                         TraceResults& results, int threads, base::Progress& progress) {
  const double expected = progress.on_terminal()
                              ? estimated_seconds(structure, input) / accel::thread_count(threads)
                              : 0.0;
  if (expected < kWorthWatching) return trace(structure, input, results, nullptr, threads);
  const base::Stopwatch stopwatch;
  auto tracing = std::async(std::launch::async, [&] {
    accel::on_default_threads([&] { trace(structure, input, results, nullptr, threads); });
  });
  while (tracing.wait_for(std::chrono::milliseconds(100)) == std::future_status::timeout) {
    progress.advance(std::min(stopwatch.seconds() / expected, 0.99));
  }
  tracing.get();
}

}  // namespace beambench::rays

#pragma once
// Traces the rays of a `TraceInput`, with progress for long runs, and stores the results.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "accel/core/accelerator.hpp"
#include "accel/core/registry.hpp"
#include "harness/base/progress.hpp"
#include "harness/rays/trace_input.hpp"

namespace beambench::rays {

/// For each ray of an any-hit query: 1 for a hit, 0 for a miss.
using AnyHits = std::vector<std::uint8_t>;
using TraceResults = std::variant<accel::HitBuffer, AnyHits>;

/// Returns results in the shape of the input, all of them misses.
TraceResults make_results(const TraceInput& input);

/// Overwrites all results with impossible ones, so that the differ finds any that are left
/// unwritten.
void poison(TraceResults& results);
void poison(accel::HitBuffer& hits);

/// Returns whether the result at an index is a hit. A poisoned result counts as a hit.
bool is_hit_at(const TraceResults& results, std::size_t index);

/// Returns whether a structure supports the kind of input: an image, or a list of rays.
bool is_supported(const accel::StructureChoice& choice, const TraceInput& input);
/// Throws UnsupportedError if the structure does not support it.
void require_support(const accel::StructureChoice& choice, const TraceInput& input);

/// Traces the rays through a structure. `results` must have the shape that `make_results` returns.
/// `counters` may be null. Up to `threads` threads share the rays (`accel::thread_count`).
void trace(const accel::Accelerator& structure, const TraceInput& input, TraceResults& results,
           accel::WorkCounters* counters = nullptr, int threads = 1);

/// Returns a warning if less than 1% or more than 99% of the rays hit anything (are occluded):
/// times for such rays mostly compare how structures handle misses only, or hits only.
std::optional<std::string> share_warning(const TraceInput& input, std::uint64_t hits);

/// Calls `trace` without counters. On a terminal, shows the remaining time, estimated by first
/// tracing a few rays.
void trace_with_progress(const accel::Accelerator& structure, const TraceInput& input,
                         TraceResults& results, int threads, base::Progress& progress);

}  // namespace beambench::rays

#pragma once
// Tracing the rays of a `TraceInput`, with progress where it takes long, and the results.

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

/// For each ray of an any-hit query: 1 where there is a hit, 0 where there is none.
using AnyHits = std::vector<std::uint8_t>;
using TraceResults = std::variant<accel::HitBuffer, AnyHits>;

/// Results of the input's shape: all misses.
TraceResults make_results(const TraceInput& input);

/// Overwrites all of them with impossible results: the differ finds every one left unwritten.
void poison(TraceResults& results);
void poison(accel::HitBuffer& hits);

/// Is the result at an index a hit? Poison counts as one.
bool is_hit_at(const TraceResults& results, std::size_t index);

/// Throws UnsupportedError where a structure does not take an image, or lists of rays.
void require_support(const accel::StructureChoice& choice, const TraceInput& input);

/// Traces the rays through a structure. `results` has the shape that `make_results` gives.
/// `counters` may be null. An image is traced on that many threads (`accel::thread_count`), a list
/// on the calling one.
void trace(const accel::Accelerator& structure, const TraceInput& input, TraceResults& results,
           accel::WorkCounters* counters = nullptr, int threads = 1);

/// A sentence where less than 1% or more than 99% of the rays hit anything (are occluded): times
/// over them compare how structures miss, or how they find anything at all, and little else.
std::optional<std::string> share_warning(const TraceInput& input, std::uint64_t hits);

/// `trace` without counters; on a terminal with the remaining time, estimated from a few rays that
/// are traced first.
void trace_with_progress(const accel::Accelerator& structure, const TraceInput& input,
                         TraceResults& results, int threads, base::Progress& progress);

}  // namespace beambench::rays

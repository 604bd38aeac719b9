#pragma once
// Tracing while the user sees how much is done.

#include "harness/base/progress.hpp"
#include "harness/rays/trace_results.hpp"

namespace beambench::rays {

/// `trace` without counters; on a terminal with the remaining time, estimated
/// from a few rays traced before.
void trace_with_progress(const accel::Accelerator& structure, const TraceInput& input,
                         TraceResults& results, int threads, base::Progress& progress);

}  // namespace beambench::rays

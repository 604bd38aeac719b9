#pragma once
// Asking a structure while the user watches.

#include "harness/base/progress.hpp"
#include "harness/rays/trace_results.hpp"

namespace beambench::cli {

/// `rays::trace` of a structure; on a terminal with the remaining time, estimated
/// from a few rays traced beforehand.
void watched_ask(const accel::Accelerator& structure, const rays::TraceInput& input,
                 rays::TraceResults& results, int threads, base::Progress& progress);

}  // namespace beambench::cli

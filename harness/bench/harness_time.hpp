#pragma once
// The harness's own time within a trace.

#include <functional>

namespace beambench::bench {

/// What a trace takes that costs a structure nothing: the median of several in milliseconds, after
/// one that is not timed. `core` is to pin to; -1: any.
double harness_ms(int core, const std::function<void()>& trace);

}  // namespace beambench::bench

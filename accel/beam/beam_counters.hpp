#pragma once
// The meaning of the beam counters.

#include <vector>

#include "accel/core/registry.hpp"

namespace beambench::accel::beam {

/// Returns the counters explained in accel/beam/README.md, in the order of `beambench list`.
std::vector<CounterInfo> beam_counters();

}  // namespace beambench::accel::beam

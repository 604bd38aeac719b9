#pragma once
// The meaning of what is counted of beams.

#include <vector>

#include "accel/core/registry.hpp"

namespace beambench::accel::beam {

/// As accel/beam/README.md explains them, in the order of `beambench list`.
std::vector<CounterInfo> beam_counters();

}  // namespace beambench::accel::beam

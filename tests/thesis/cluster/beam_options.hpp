#pragma once
// The options of beams in the tests of the cluster.

#include <cstdint>

#include "accel/beam/beam_tracer.hpp"

namespace beambench::tests {

inline accel::beam::BeamOptions options_with(int max_level, std::int64_t handover = 0) {
  accel::beam::BeamOptions options;
  options.octree.max_level = max_level;
  options.handover = handover;
  return options;
}

}  // namespace beambench::tests

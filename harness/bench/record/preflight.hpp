#pragma once
// What is said of the machine before a run.

#include <optional>
#include <string>
#include <vector>

#include "harness/bench/record/manifest.hpp"

namespace beambench::bench {

/// A sentence where equal work took too unequal times before the run (harness/bench/noise.hpp).
std::optional<std::string> noise_warning(const std::optional<double>& noise);

/// Two lines on the machine, and a warning in plain words for each thing that could not be
/// controlled.
std::vector<std::string> preflight(const Manifest& manifest);

}  // namespace beambench::bench

#pragma once
// What is known of a run when it begins.

#include <chrono>
#include <string>
#include <vector>

#include "harness/bench/record/manifest.hpp"

namespace beambench::bench {

/// The manifest of a new run of the sweep of that name, whose timed code is pinned to `core` (-1:
/// to none) and runs on so many threads, after a warm-up: asks this program, the machine and Embree
/// for the rest.
Manifest begin_manifest(const std::string& sweep, std::vector<SceneFacts> scenes, int core,
                        int threads, std::chrono::duration<double> warm_up);

}  // namespace beambench::bench

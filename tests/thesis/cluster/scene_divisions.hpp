#pragma once
// Every way to divide a scene among processes.

#include <array>

#include "harness/thesis/cluster/split/scene_division.hpp"

namespace beambench::tests {

using cluster::SceneDivision;

inline constexpr std::array kSceneDivisions{SceneDivision::kPrimitives, SceneDivision::kCost,
                                            SceneDivision::kInterleaved, SceneDivision::kBisection,
                                            SceneDivision::kScattered};

}  // namespace beambench::tests

#pragma once
// Predicts the memory that building a structure will take.

#include <cstdint>
#include <optional>

#include "accel/core/registry.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel {

/// Predicts by how many bytes a build raises this process's memory at its peak. Measures a build
/// over an eighth of the primitives, taken in evenly spaced runs, and scales the result. Meshes of
/// 2 to 8 million triangles took 0.7 to 1.1 times the prediction. Returns nothing if the measured
/// build is refused or the system does not report memory.
std::optional<std::uint64_t> predicted_build_bytes(const StructureChoice& choice,
                                                   const scenes::Scene& scene,
                                                   const Workload& workload);

/// Throws InputError, with the figures, when a build is expected to take more memory than is
/// available (`available_memory`). Makes the prediction only for scenes that are large enough for
/// this to be possible; for smaller scenes the check is free.
void require_build_memory(const StructureChoice& choice, const scenes::Scene& scene,
                          const Workload& workload);

}  // namespace beambench::accel

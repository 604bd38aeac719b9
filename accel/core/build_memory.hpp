#pragma once
// The memory that building a structure will take, predicted before it is taken.

#include <cstdint>
#include <optional>

#include "accel/core/registry.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel {

/// Predicts the number of bytes by which a build raises the memory of this process at its peak.
/// Measures a build over an eighth of the primitives, in runs that are evenly spread, and
/// multiplies. Meshes of 2 to 8 million triangles took 0.7 to 1.1 times the prediction. Returns
/// nothing where that build is refused, or where the system does not report its memory.
std::optional<std::uint64_t> predicted_build_bytes(const StructureChoice& choice,
                                                   const scenes::Scene& scene,
                                                   const Workload& workload);

/// Throws InputError, with the figures, when a build is expected to take more memory than is
/// available (`available_memory`). Predicts only for scenes so large that this is conceivable; for
/// others the check costs nothing.
void require_build_memory(const StructureChoice& choice, const scenes::Scene& scene,
                          const Workload& workload);

}  // namespace beambench::accel

#pragma once
// The memory that building a structure will take, predicted before it is taken.

#include <cstdint>
#include <optional>

#include "accel/core/registry.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel {

/// By how many bytes a build is expected to raise the memory of this process at its peak: measured
/// at a build over an eighth of the primitives, in runs that are evenly spread, and multiplied.
/// Meshes of 2 to 8 million triangles took 0.7 to 1.1 times of it. Nothing where that build is
/// refused, or where the system does not say what it takes.
std::optional<std::uint64_t> predicted_build_bytes(const StructureChoice& choice,
                                                   const scenes::Scene& scene,
                                                   const Workload& workload);

/// Throws InputError, with the figures, when a build is expected to take more memory than there is
/// (`available_memory`). Predicts only for scenes so large, for the memory there is, that this is
/// conceivable: others cost nothing.
void require_build_memory(const StructureChoice& choice, const scenes::Scene& scene,
                          const Workload& workload);

}  // namespace beambench::accel

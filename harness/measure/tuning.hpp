#pragma once
// Tuning decides which of a contender's parameter sets are measured. The sets are timed with a
// camera other than the reported one: if they were timed on the reported data, the fastest would be
// fastest partly by chance. Every contender has the same budget.

#include <cstddef>
#include <map>
#include <vector>

#include "accel/core/registry.hpp"
#include "harness/measure/block.hpp"
#include "scenes/base/parameters.hpp"
#include "scenes/camera.hpp"

namespace beambench::measure {

/// The maximum number of parameter sets tried for one contender.
inline constexpr std::size_t kMaxParameterSets = 8;
/// The number of parameter sets that are measured.
inline constexpr std::size_t kMeasuredSets = 2;

/// Embree tuned over its modes and flags, in sweeps and after `--accel`.
inline const Spec kBestEmbree{"embree", {{"mode", "best"}}};
inline constexpr const char* kBestEmbreeText = "embree:mode=best";

/// Returns the parameter sets that `kBestEmbree` tries: each mode without watertight edges, which
/// cost time, and the wide modes both with and without the flag for coherent rays. There are at
/// most `kMaxParameterSets`.
std::vector<accel::StructureChoice> best_embree(const accel::Registry& structures);

/// Returns the tuning camera: turned about its own position, around its upward direction, by a
/// quarter of its field of view. Three quarters of what it sees are in the view, also in a closed
/// room, which a camera that moves may leave.
scenes::Camera tuning_camera(const scenes::Camera& camera);

/// Times the block's cells with the tuning camera of its view: each is built once and traced a few
/// times, and the fastest trace counts. Writes an event `candidate` for each cell, with its
/// `trace_ms` or with the `error` that prevented the trace. Hits are not verified here; those of
/// the fastest sets are verified when they are measured.
void time_candidates(const Block& block, const BlockWatch& watch);

/// Returns the indices of the fastest candidates, at most `kMeasuredSets`. If no candidate has a
/// time, returns `all`: none may be preferred. `times` is keyed by index.
std::vector<std::size_t> fastest(const std::map<std::size_t, double>& times,
                                 const std::vector<std::size_t>& all);

}  // namespace beambench::measure

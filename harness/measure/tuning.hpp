#pragma once
// Tuning: which of a contender's parameter sets are measured. All are timed from another camera
// than that which is reported, because the fastest of several on the data that are reported would
// be fastest in part by chance; and every contender has the same budget.

#include <cstddef>
#include <map>
#include <vector>

#include "accel/core/registry.hpp"
#include "harness/measure/block.hpp"
#include "scenes/base/parameters.hpp"
#include "scenes/camera.hpp"

namespace beambench::measure {

/// The number of parameter sets that may be tried for one contender.
inline constexpr std::size_t kMaxParameterSets = 8;
/// The number of them that are measured.
inline constexpr std::size_t kMeasuredSets = 2;

/// Embree tuned over its modes and flags, in sweeps and after `--accel`.
inline const Spec kBestEmbree{"embree", {{"mode", "best"}}};
inline constexpr const char* kBestEmbreeText = "embree:mode=best";

/// Returns what `kBestEmbree` tries: each mode, without watertight edges, which cost time, and the
/// wide ones with and without the flag for coherent rays. At most `kMaxParameterSets`.
std::vector<accel::StructureChoice> best_embree(const accel::Registry& structures);

/// Returns the tuning camera: turned by 15 degrees about the point that it looks at, around its
/// upward direction.
scenes::Camera tuning_camera(const scenes::Camera& camera);

/// Times the block's cells from the tuning camera of its view: each is built once and traced a few
/// times, and the fastest trace counts. Writes an event `candidate` for each, with its `trace_ms`
/// or the `error` for which it has none. No hit is verified: those of the fastest will be.
void time_candidates(const Block& block, const BlockWatch& watch);

/// Returns the indices of the fastest candidates, at most `kMeasuredSets`; the first of all where
/// none has a time, which will show why. `times` is by index.
std::vector<std::size_t> fastest(const std::map<std::size_t, double>& times,
                                 const std::vector<std::size_t>& all);

}  // namespace beambench::measure

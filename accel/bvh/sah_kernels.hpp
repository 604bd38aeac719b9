#pragma once
// The traversals of the wide hierarchy, compiled for several instruction sets.

#include <cstdint>
#include <optional>

#include "accel/bvh/wide_bvh.hpp"
#include "accel/core/ray.hpp"
#include "accel/core/trace_step.hpp"
#include "accel/core/work_counters.hpp"

namespace beambench::accel::bvh {

/// Both queries with one counting policy. Must not be used for empty hierarchies.
template <class Counting>
struct SahQueries {
  std::optional<Hit> (*closest)(const WideBvh&, const scenes::Scene&, const Ray&, Counting&);
  bool (*any)(const WideBvh&, const scenes::Scene&, const Ray&, Counting&);
};

/// The queries for one instruction set.
struct SahKernels : SahQueries<NoCounting>, SahQueries<WorkCounters>, SahQueries<StepRecorder> {
  std::int64_t target;  ///< HWY_TARGET; hwy::TargetName returns its name

  template <class Counting>
  const SahQueries<Counting>& queries() const {
    return *this;
  }
};

/// Returns the kernels for this machine's best instruction set among the Highway targets `targets`,
/// as returned by `targets_of`.
const SahKernels& sah_kernels_for(std::int64_t targets);

}  // namespace beambench::accel::bvh

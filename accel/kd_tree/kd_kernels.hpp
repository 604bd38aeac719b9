#pragma once
// The traversals of the kd-tree, compiled for several instruction sets.

#include <cstdint>
#include <optional>

#include "accel/core/ray.hpp"
#include "accel/core/trace_step.hpp"
#include "accel/core/work_counters.hpp"
#include "accel/kd_tree/kd_tree.hpp"

namespace beambench::accel::kd_tree {

/// Both queries with one counting policy. Must not be used for empty trees.
template <class Counting>
struct KdQueries {
  std::optional<Hit> (*closest)(const KdTree&, const scenes::Scene&, const Ray&, Counting&);
  bool (*any)(const KdTree&, const scenes::Scene&, const Ray&, Counting&);
};

/// The queries for one instruction set.
struct KdKernels : KdQueries<NoCounting>, KdQueries<WorkCounters>, KdQueries<StepRecorder> {
  std::int64_t target;  ///< HWY_TARGET; hwy::TargetName returns its name

  template <class Counting>
  const KdQueries<Counting>& queries() const {
    return *this;
  }
};

/// Returns the kernels for this machine's best instruction set that Highway supports.
const KdKernels& best_kd_kernels();

}  // namespace beambench::accel::kd_tree

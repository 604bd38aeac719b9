#pragma once
// The traversal of the wide hierarchy by streams of rays, compiled for several instruction sets.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "accel/bvh/stream_tree.hpp"
#include "accel/bvh/wide_bvh.hpp"
#include "accel/core/ray.hpp"
#include "accel/core/work_counters.hpp"

namespace beambench::accel::bvh {

/// Rays that traverse the hierarchy together, and the destinations of their results.
struct Stream {
  /// The maximum number of rays, so that their rows, lists and hits stay in a core's caches.
  static constexpr std::size_t kMostRays = std::size_t{1} << 15U;

  const WideBvh& bvh;
  const StreamTree& tree;
  const scenes::Scene& scene;
  std::span<const Ray> rays;
  // Closest-hit queries write `t` and `primitive`, any-hit queries write 1 or 0 to `any`.
  float* t = nullptr;
  scenes::PrimitiveId* primitive = nullptr;
  std::uint8_t* any = nullptr;
};

/// Both queries with one counting policy. They append to `left` the rays that they cannot trace and
/// that must be traced singly. Must not be used for empty hierarchies.
template <class Counting>
struct StreamQueries {
  using Query = void (*)(const Stream&, std::vector<std::uint32_t>& left, Counting&);
  Query closest;
  Query any;
};

struct StreamKernels : StreamQueries<NoCounting>, StreamQueries<WorkCounters> {
  template <class Counting>
  const StreamQueries<Counting>& queries() const {
    return *this;
  }
};

/// Returns the kernels for this machine's best instruction set among the Highway targets `targets`,
/// as returned by `targets_of`.
const StreamKernels& stream_kernels_for(std::int64_t targets);

}  // namespace beambench::accel::bvh

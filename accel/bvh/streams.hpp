#pragma once
// Lists of rays that traverse a wide hierarchy together.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "accel/bvh/stream_kernels.hpp"
#include "accel/core/hit_buffer.hpp"
#include "accel/core/registry.hpp"

namespace beambench::accel::bvh {

/// Returns the descriptions of the stream counters, for `Registry::describe_counters`.
std::vector<CounterInfo> stream_counters();

/// A hierarchy over a scene, and the kernels that traverse it by streams. All referenced objects
/// must outlive it.
struct Streams {
  /// The minimum number of rays for a list to be traced as streams.
  static constexpr std::size_t kLeast = 320;

  /// Returns the number of streams that a list is divided into. Their equal sizes do not depend on
  /// the number of threads, so neither do hits and counters.
  static constexpr std::size_t parts(std::size_t rays) {
    return (rays + Stream::kMostRays - 1) / Stream::kMostRays;
  }
  /// Returns the first ray of a part, or the end of the list if `part` is `parts(rays)`.
  static constexpr std::size_t begin_of(std::size_t part, std::size_t rays) {
    return rays * part / parts(rays);
  }

  const WideBvh& bvh;
  const StreamTree& tree;
  const scenes::Scene& scene;
  const StreamKernels& kernels;

  /// Writes the closest hits of one part's rays. Calls `trace_alone(i)` for each ray that the
  /// stream did not decide.
  template <class Counting, class TraceAlone>
  void closest_hits(std::span<const Ray> rays, const HitSpan& hits, Counting& counting,
                    const TraceAlone& trace_alone) const {
    Stream stream{bvh, tree, scene, rays};
    stream.t = hits.t();
    stream.primitive = hits.primitive();
    trace(kernels.queries<Counting>().closest, stream, counting, trace_alone);
  }

  /// Writes 1 for each ray of a part that hits anything and 0 for the others. Uses `trace_alone` as
  /// `closest_hits` does.
  template <class Counting, class TraceAlone>
  void any_hits(std::span<const Ray> rays, std::span<std::uint8_t> hits, Counting& counting,
                const TraceAlone& trace_alone) const {
    Stream stream{bvh, tree, scene, rays};
    stream.any = hits.data();
    trace(kernels.queries<Counting>().any, stream, counting, trace_alone);
  }

 private:
  template <class Counting, class TraceAlone>
  static void trace(typename StreamQueries<Counting>::Query query, const Stream& stream,
                    Counting& counting, const TraceAlone& trace_alone) {
    std::vector<std::uint32_t> left;
    query(stream, left, counting);
    for (const std::uint32_t i : left) trace_alone(i);
    counting.add("stream_left", left.size());
  }
};

}  // namespace beambench::accel::bvh

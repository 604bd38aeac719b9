#include "accel/embree/list_tracers.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "accel/core/pick_target.hpp"

// Highway includes this file again for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/embree/list_tracers.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "accel/embree/packet_owners-inl.hpp"
#include "accel/embree/unit_directions-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::embree::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <int N>
using Valid = std::array<int, N>;

/// Sets the values that Embree does not change and that do not come from the rays.
template <class Rays>
void prepare(Rays& out) {
  std::ranges::fill(out.time, 0.0F);
  std::ranges::fill(out.mask, std::numeric_limits<unsigned>::max());
}

/// Loads N consecutive rays into the lanes of a packet.
template <int N, class Rays>
void fill_lanes(const Ray* rays, Rays& out) {
  using Floats = hn::CappedTag<float, N>;
  const Floats floats;
  if constexpr (hn::MaxLanes(Floats()) == 1) {
    for (int i = 0; i < N; ++i) {
      out.org_x[i] = rays[i].origin.x;
      out.org_y[i] = rays[i].origin.y;
      out.org_z[i] = rays[i].origin.z;
      out.tnear[i] = rays[i].t_min;
      out.dir_x[i] = rays[i].direction.x;
      out.dir_y[i] = rays[i].direction.y;
      out.dir_z[i] = rays[i].direction.z;
      out.tfar[i] = rays[i].t_max;
    }
  } else {
    // A ray is eight floats: origin, t_min, direction, t_max. As groups of four floats, the even
    // lanes hold origins and the odd lanes directions, for half as many rays as lanes.
    static_assert(sizeof(Ray) == 8 * sizeof(float));
    for (std::size_t lane = 0; lane < N; lane += hn::Lanes(floats)) {
      const float* const first = &rays[lane].origin.x;
      hn::Vec<Floats> x0, y0, z0, t0, x1, y1, z1, t1;
      hn::LoadInterleaved4(floats, first, x0, y0, z0, t0);
      hn::LoadInterleaved4(floats, first + 4 * hn::Lanes(floats), x1, y1, z1, t1);
      hn::Store(ConcatEven(floats, x1, x0), floats, out.org_x + lane);
      hn::Store(ConcatEven(floats, y1, y0), floats, out.org_y + lane);
      hn::Store(ConcatEven(floats, z1, z0), floats, out.org_z + lane);
      hn::Store(ConcatEven(floats, t1, t0), floats, out.tnear + lane);
      hn::Store(ConcatOdd(floats, x1, x0), floats, out.dir_x + lane);
      hn::Store(ConcatOdd(floats, y1, y0), floats, out.dir_y + lane);
      hn::Store(ConcatOdd(floats, z1, z0), floats, out.dir_z + lane);
      hn::Store(ConcatOdd(floats, t1, t0), floats, out.tfar + lane);
    }
  }
}

/// Calls `trace(first, count, rays)` for packets of N rays. The first `count` rays of a packet are
/// from the list; the others have an empty interval.
template <int N, class Trace>
void for_each_packet(std::span<const Ray> rays, Trace trace) {
  const std::size_t whole = rays.size() / N * N;
  for (std::size_t first = 0; first < whole; first += N) trace(first, std::size_t{N}, &rays[first]);
  if (whole == rays.size()) return;
  std::array<Ray, N> last;
  last.fill({.t_max = -kInfinity});
  std::ranges::copy(rays.subspan(whole), last.begin());
  trace(whole, rays.size() - whole, last.data());
}

template <int N>
Valid<N> valid_lanes(std::size_t count) {
  Valid<N> valid{};
  std::fill_n(valid.begin(), count, -1);
  return valid;
}

template <int N, class Query>
void aim(const Ray* rays, Query& query) {
  fill_lanes<N>(rays, query.ray);
  std::ranges::fill(query.hit.geomID, RTC_INVALID_GEOMETRY_ID);
}

/// Writes the hits of a packet to a buffer; the t of a miss is infinity, wherever its ray ends.
template <int N, class Query>
HWY_INLINE void write(const OwnerTable& table, const Query& query, std::size_t first,
                      std::size_t count, const HitSpan& buffer) {
  alignas(64) std::array<scenes::PrimitiveId, N> owners;
  alignas(64) std::array<float, N> t;
  find_owners<N>(table, query.hit, owners.data());
  for (std::size_t i = 0; i < N; ++i) {
    t[i] = owners[i] == scenes::kNoPrimitive ? kInfinity : query.ray.tfar[i];
  }
  std::copy_n(t.begin(), count, buffer.t() + first);
  std::copy_n(owners.begin(), count, buffer.primitive() + first);
}

/// Writes which rays are occluded, which Embree marks by tfar = -infinity.
template <class Rays>
void write(const Rays& rays, std::size_t first, std::size_t count,
           std::span<std::uint8_t> answers) {
  for (std::size_t i = 0; i < count; ++i) {
    answers[first + i] = rays.tfar[i] == -kInfinity ? 1 : 0;
  }
}

void closest_hits_single(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                         const HitSpan& buffer) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::optional<Hit> hit = scene.closest_hit(context, rays[i]);
    buffer.t()[i] = hit ? hit->t : kInfinity;
    buffer.primitive()[i] = hit ? hit->primitive : scenes::kNoPrimitive;
  }
}

void any_hits_single(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                     std::span<std::uint8_t> answers) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    answers[i] = scene.any_hit(context, rays[i]) ? 1 : 0;
  }
}

/// Traces a list; `intersect(valid, query)` finds the closest hits of a packet.
template <int N, class Intersect>
void closest_hits_by_packets(const OwnerTable& owners, std::span<const Ray> rays,
                             const HitSpan& buffer, Intersect intersect) {
  typename Packet<N>::Query query{};
  prepare(query.ray);
  for_each_packet<N>(rays, [&](std::size_t first, std::size_t count, const Ray* some) {
    alignas(64) const Valid<N> valid = valid_lanes<N>(count);
    aim<N>(some, query);
    intersect(valid.data(), query);
    write<N>(owners, query, first, count, buffer);
  });
}

/// Traces a list; `intersect_any(valid, rays)` marks the rays of a packet that hit anything.
template <int N, class IntersectAny>
void any_hits_by_packets(std::span<const Ray> rays, std::span<std::uint8_t> answers,
                         IntersectAny intersect_any) {
  typename Packet<N>::Rays query{};
  prepare(query);
  for_each_packet<N>(rays, [&](std::size_t first, std::size_t count, const Ray* some) {
    alignas(64) const Valid<N> valid = valid_lanes<N>(count);
    fill_lanes<N>(some, query);
    intersect_any(valid.data(), query);
    write(query, first, count, answers);
  });
}

template <int N>
void closest_hits_in_packets(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                             const HitSpan& buffer) {
  closest_hits_by_packets<N>(scene.owners(), rays, buffer, [&](const int* valid, auto& query) {
    trace_packet<N>(scene, query.ray, [&] { intersect(valid, scene.get(), context, query); });
  });
}

template <int N>
void any_hits_in_packets(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                         std::span<std::uint8_t> answers) {
  any_hits_by_packets<N>(rays, answers, [&](const int* valid, auto& query) {
    trace_packet<N>(scene, query, [&] { intersect_any(valid, scene.get(), context, query); });
  });
}

#if BEAMBENCH_EMBREE_MAJOR == 3
/// Embree's own packet width, that of its registers: 4, 8 or 16. It copies the rays of other
/// packets one by one (kernels/bvh/bvh_intersector_stream_filters, filterSOA).
constexpr int kStreamLanes =
    std::max(4, static_cast<int>(hn::MaxLanes(hn::CappedTag<float, 16>())));
constexpr std::size_t kStream = 256;

/// Traces a list stream by stream: calls `trace(packets)` for the packets of a stream, then
/// `store(query, first, count)` for each packet.
template <class Query, class Aim, class Trace, class Store>
void trace_streams(std::span<const Ray> rays, std::vector<Query>& queries, Aim aim, Trace trace,
                   Store store) {
  for (std::size_t begin = 0; begin < rays.size(); begin += kStream) {
    const auto some = rays.subspan(begin, std::min(kStream, rays.size() - begin));
    unsigned filled = 0;
    for_each_packet<kStreamLanes>(
        some, [&](std::size_t, std::size_t, const Ray* packet) { aim(packet, queries[filled++]); });
    trace(filled);
    for (unsigned i = 0; i < filled; ++i) {
      const std::size_t first = i * std::size_t{kStreamLanes};
      store(queries[i], begin + first, std::min<std::size_t>(kStreamLanes, some.size() - first));
    }
  }
}

void closest_hits_in_streams(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                             const HitSpan& buffer) {
  using Query = Packet<kStreamLanes>::Query;
  std::vector<Query> queries(kStream / kStreamLanes);
  for (Query& query : queries) prepare(query.ray);
  trace_streams(
      rays, queries, [](const Ray* some, Query& query) { aim<kStreamLanes>(some, query); },
      [&](unsigned count) {
        trace_packets_at_once<kStreamLanes>(
            scene, queries, count, [](Query & query) -> auto& { return query.ray; },
            [&] { intersect_stream(scene.get(), context, queries.data(), count); });
      },
      [&](const Query& query, std::size_t first, std::size_t count) {
        write<kStreamLanes>(scene.owners(), query, first, count, buffer);
      });
}

void any_hits_in_streams(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                         std::span<std::uint8_t> answers) {
  using Query = Packet<kStreamLanes>::Rays;
  std::vector<Query> queries(kStream / kStreamLanes);
  for (Query& query : queries) prepare(query);
  trace_streams(
      rays, queries, [](const Ray* some, Query& query) { fill_lanes<kStreamLanes>(some, query); },
      [&](unsigned count) {
        trace_packets_at_once<kStreamLanes>(
            scene, queries, count, [](Query & query) -> auto& { return query; },
            [&] { intersect_any_stream(scene.get(), context, queries.data(), count); });
      },
      [&](const Query& query, std::size_t first, std::size_t count) {
        write(query, first, count, answers);
      });
}
constexpr ListMode kStreams{closest_hits_in_streams, any_hits_in_streams};
#else
constexpr ListMode kStreams{nullptr, nullptr};
#endif

void untraced_closest(const OwnerTable& owners, std::span<const Ray> rays, const HitSpan& buffer) {
  closest_hits_by_packets<16>(owners, rays, buffer, [](const int* valid, auto& query) {
    // Makes the compiler assume that the whole query is used.
    asm volatile("" : "+m"(query) : "r"(valid) : "memory");
  });
}

void untraced_any(std::span<const Ray> rays, std::span<std::uint8_t> answers) {
  any_hits_by_packets<16>(rays, answers, [](const int* valid, auto& query) {
    asm volatile("" : "+m"(query) : "r"(valid) : "memory");
  });
}

template <int N>
constexpr ListMode kPackets{closest_hits_in_packets<N>, any_hits_in_packets<N>};

const ListTracers& tracers_of_lists() {
  static constexpr ListTracers kTracers{{closest_hits_single, any_hits_single},
                                        kPackets<4>,
                                        kPackets<8>,
                                        kPackets<16>,
                                        kStreams,
                                        untraced_closest,
                                        untraced_any};
  return kTracers;
}

}  // namespace beambench::accel::embree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace beambench::accel::embree {

HWY_EXPORT(tracers_of_lists);

const ListTracers& list_tracers(std::int64_t targets) {
  return pick_target(HWY_DISPATCH_TABLE(tracers_of_lists), targets)();
}

}  // namespace beambench::accel::embree
#endif

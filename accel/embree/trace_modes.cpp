#include "accel/embree/trace_modes.hpp"

#include <algorithm>
#include <array>

namespace beambench::accel::embree {
namespace {

template <int N>
using Valid = std::array<int, N>;

/// The rays of a list from `first` on, as many as there are, in the lanes of a packet.
template <int N>
std::size_t fill_lanes(std::span<const Ray> rays, std::size_t first, typename Packet<N>::Rays& out,
                       Valid<N>& valid) {
  const std::size_t count = std::min<std::size_t>(N, rays.size() - first);
  for (std::size_t i = 0; i < N; ++i) {
    const bool used = i < count;
    const Ray ray = used ? rays[first + i] : Ray{};
    out.org_x[i] = ray.origin.x;
    out.org_y[i] = ray.origin.y;
    out.org_z[i] = ray.origin.z;
    out.dir_x[i] = ray.direction.x;
    out.dir_y[i] = ray.direction.y;
    out.dir_z[i] = ray.direction.z;
    out.tnear[i] = ray.t_min;
    out.tfar[i] = ray.t_max;
    out.time[i] = 0.0F;
    out.mask[i] = std::numeric_limits<unsigned>::max();
    valid[i] = used ? -1 : 0;
  }
  return count;
}

void closest_hits_single(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                         HitBuffer& buffer) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RTCRayHit query = to_embree_query(rays[i]);
    intersect(scene.get(), context, query);
    const scenes::PrimitiveId owner = scene.owner(query.hit.geomID, query.hit.primID);
    buffer.t()[i] = owner == scenes::kNoPrimitive ? kInfinity : query.ray.tfar;
    buffer.primitive()[i] = owner;
  }
}

void any_hits_single(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                     std::span<std::uint8_t> answers) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RTCRay query = to_embree(rays[i]);
    answers[i] = occluded(scene.get(), context, query) ? 1 : 0;
  }
}

template <int N>
void closest_hits_by_packets(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                             HitBuffer& buffer) {
  alignas(64) Valid<N> valid{};
  typename Packet<N>::Query query{};
  for (std::size_t first = 0; first < rays.size(); first += N) {
    const std::size_t count = fill_lanes<N>(rays, first, query.ray, valid);
    std::fill_n(query.hit.geomID, N, RTC_INVALID_GEOMETRY_ID);
    intersect(valid.data(), scene.get(), context, query);
    for (std::size_t i = 0; i < count; ++i) {
      const scenes::PrimitiveId owner = scene.owner(query.hit.geomID[i], query.hit.primID[i]);
      buffer.t()[first + i] = owner == scenes::kNoPrimitive ? kInfinity : query.ray.tfar[i];
      buffer.primitive()[first + i] = owner;
    }
  }
}

template <int N>
void any_hits_by_packets(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                         std::span<std::uint8_t> answers) {
  alignas(64) Valid<N> valid{};
  typename Packet<N>::Rays query{};
  for (std::size_t first = 0; first < rays.size(); first += N) {
    const std::size_t count = fill_lanes<N>(rays, first, query, valid);
    intersect_any(valid.data(), scene.get(), context, query);
    for (std::size_t i = 0; i < count; ++i) {
      answers[first + i] = query.tfar[i] == -kInfinity ? 1 : 0;
    }
  }
}

constexpr TraceMode kModes[] = {
    {"single", &ImageTracers::single, closest_hits_single, any_hits_single},
    {"packet4", &ImageTracers::packet4, closest_hits_by_packets<4>, any_hits_by_packets<4>},
    {"packet8", &ImageTracers::packet8, closest_hits_by_packets<8>, any_hits_by_packets<8>},
    {"packet16", &ImageTracers::packet16, closest_hits_by_packets<16>, any_hits_by_packets<16>},
#if BEAMBENCH_EMBREE_MAJOR == 3
    // A list has no tile to make a stream of.
    {"stream", &ImageTracers::stream, closest_hits_by_packets<16>, any_hits_by_packets<16>},
#endif
};

}  // namespace

std::span<const TraceMode> trace_modes() { return kModes; }

}  // namespace beambench::accel::embree

// Directions of unit length, for Embree's cone curves. Compiled for each of Highway's targets: the
// including file is included several times.

#if defined(BEAMBENCH_EMBREE_UNIT_DIRECTIONS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BEAMBENCH_EMBREE_UNIT_DIRECTIONS_INL
#undef BEAMBENCH_EMBREE_UNIT_DIRECTIONS_INL
#else
#define BEAMBENCH_EMBREE_UNIT_DIRECTIONS_INL
#endif

#include <array>
#include <vector>

#include <hwy/highway.h>

#include "accel/embree/native_scene.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::embree::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Normalizes the directions of a packet's N rays, and restores their t afterward.
template <int N>
class UnitDirections {
 public:
  template <class Rays>
  explicit UnitDirections(Rays& rays) {
    for_lanes([&](auto floats, std::size_t lane) {
      const auto x = hn::Load(floats, rays.dir_x + lane);
      const auto y = hn::Load(floats, rays.dir_y + lane);
      const auto z = hn::Load(floats, rays.dir_z + lane);
      const auto length = hn::Sqrt(hn::Add(hn::Mul(x, x), hn::Add(hn::Mul(y, y), hn::Mul(z, z))));
      hn::Store(hn::Div(x, length), floats, rays.dir_x + lane);
      hn::Store(hn::Div(y, length), floats, rays.dir_y + lane);
      hn::Store(hn::Div(z, length), floats, rays.dir_z + lane);
      hn::Store(hn::Mul(hn::Load(floats, rays.tnear + lane), length), floats, rays.tnear + lane);
      hn::Store(hn::Mul(hn::Load(floats, rays.tfar + lane), length), floats, rays.tfar + lane);
      hn::Store(length, floats, &lengths_[lane]);
    });
  }

  /// Converts t to the units of the original directions; -infinity, which marks occluded rays in
  /// Embree, is kept.
  template <class Rays>
  void restore_t(Rays& rays) const {
    for_lanes([&](auto floats, std::size_t lane) {
      hn::Store(hn::Div(hn::Load(floats, rays.tfar + lane), hn::Load(floats, &lengths_[lane])),
                floats, rays.tfar + lane);
    });
  }

 private:
  template <class Action>
  static void for_lanes(Action action) {
    const hn::CappedTag<float, N> floats;
    for (std::size_t lane = 0; lane < N; lane += hn::Lanes(floats)) action(floats, lane);
  }

  alignas(64) std::array<float, N> lengths_;
};

/// Calls `trace()` with the rays of a packet in the form that the scene's curves need.
template <int N, class Rays, class Trace>
HWY_INLINE void trace_packet(const NativeScene& scene, Rays& rays, Trace trace) {
  if (scene.curve_count() == 0) {
    trace();
    return;
  }
  const UnitDirections<N> unit(rays);
  trace();
  unit.restore_t(rays);
}

/// Calls `trace()` in the same way for the first `count` packets together, whose rays are
/// `rays_of(packet)`.
template <int N, class Packets, class RaysOf, class Trace>
void trace_packets_at_once(const NativeScene& scene, Packets& packets, unsigned count,
                           RaysOf rays_of, Trace trace) {
  if (scene.curve_count() == 0) {
    trace();
    return;
  }
  std::vector<UnitDirections<N>> unit;
  unit.reserve(count);
  for (unsigned i = 0; i < count; ++i) unit.emplace_back(rays_of(packets[i]));
  trace();
  for (unsigned i = 0; i < count; ++i) unit[i].restore_t(rays_of(packets[i]));
}

}  // namespace beambench::accel::embree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

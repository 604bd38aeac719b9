#pragma once
// The Embree API as beambench uses it, for Embree 3 and 4 (BEAMBENCH_EMBREE_MAJOR, set by CMake).
// The oracle and the contender `embree` share it.

#include <limits>

#if BEAMBENCH_EMBREE_MAJOR == 3
#include "accel/embree_api/api3.hpp"
#else
#include "accel/embree_api/api4.hpp"
#endif
#include "accel/core/ray.hpp"

namespace beambench::accel::embree {

/// Fills a ray for Embree. Debian's Embree asserts that tnear >= 0 and that nothing is NaN, which
/// `require_valid` ensures.
inline RTCRay to_embree(const Ray& ray) {
  RTCRay out{};
  out.org_x = ray.origin.x;
  out.org_y = ray.origin.y;
  out.org_z = ray.origin.z;
  out.tnear = ray.t_min;
  out.dir_x = ray.direction.x;
  out.dir_y = ray.direction.y;
  out.dir_z = ray.direction.z;
  out.tfar = ray.t_max;
  out.mask = std::numeric_limits<unsigned>::max();
  return out;
}

/// Makes a ray without a hit.
inline RTCRayHit to_embree_query(const Ray& ray) {
  RTCRayHit out{};
  out.ray = to_embree(ray);
  out.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return out;
}

/// Returns whether a ray is occluded, which Embree marks by tfar = -infinity.
inline bool occluded(RTCScene scene, Context& context, RTCRay& ray) {
  intersect_any(scene, context, ray);
  return ray.tfar == -kInfinity;
}

/// The Embree types for a packet of N rays, and the block of pixels that it covers.
template <int N>
struct Packet;

template <>
struct Packet<4> {
  using Query = RTCRayHit4;
  using Rays = RTCRay4;
  static constexpr int kWidth = 2;
};

template <>
struct Packet<8> {
  using Query = RTCRayHit8;
  using Rays = RTCRay8;
  static constexpr int kWidth = 4;
};

template <>
struct Packet<16> {
  using Query = RTCRayHit16;
  using Rays = RTCRay16;
  static constexpr int kWidth = 4;
};

}  // namespace beambench::accel::embree

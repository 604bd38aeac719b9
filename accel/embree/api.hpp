#pragma once
// The Embree API as this folder uses it. What differs between Embree's major versions is here and
// in the callbacks of user geometry; nothing outside this folder includes it.

#include <cstddef>
#include <limits>

#include <embree3/rtcore.h>

#include "accel/ray.hpp"

namespace beambench::embree {

/// What Embree hands on to user geometry; derive from it to carry the state of a query.
struct Context : RTCIntersectContext {
  explicit Context(bool coherent) {
    rtcInitIntersectContext(this);
    flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }
};

/// Fills a ray for Embree. Debian's Embree asserts that tnear >= 0 and that nothing is NaN, which
/// `require_valid` has seen to.
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

/// A ray with its hit still open.
inline RTCRayHit to_embree_query(const Ray& ray) {
  RTCRayHit out{};
  out.ray = to_embree(ray);
  out.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return out;
}

inline void intersect(RTCScene scene, Context& context, RTCRayHit& query) {
  rtcIntersect1(scene, &context, &query);
}

/// Embree marks an occluded ray by tfar = -infinity.
inline bool occluded(RTCScene scene, Context& context, RTCRay& ray) {
  rtcOccluded1(scene, &context, &ray);
  return ray.tfar == -kInfinity;
}

/// The packet of N rays and the block of pixels it covers.
template <int N>
struct Packet;

template <>
struct Packet<4> {
  using Query = RTCRayHit4;
  static constexpr int kWidth = 2;
  static void intersect(const int* valid, RTCScene scene, Context& context, Query& query) {
    rtcIntersect4(valid, scene, &context, &query);
  }
};

template <>
struct Packet<8> {
  using Query = RTCRayHit8;
  static constexpr int kWidth = 4;
  static void intersect(const int* valid, RTCScene scene, Context& context, Query& query) {
    rtcIntersect8(valid, scene, &context, &query);
  }
};

template <>
struct Packet<16> {
  using Query = RTCRayHit16;
  static constexpr int kWidth = 4;
  static void intersect(const int* valid, RTCScene scene, Context& context, Query& query) {
    rtcIntersect16(valid, scene, &context, &query);
  }
};

/// A stream of packets of 16 in one go; rays with tfar < tnear are left out. Embree 4 has none:
/// there packets one by one take its place.
inline void intersect_stream(RTCScene scene, Context& context, RTCRayHit16* queries,
                             unsigned count) {
  rtcIntersectNM(scene, &context, reinterpret_cast<RTCRayHitN*>(queries), 16, count,
                 sizeof(RTCRayHit16));
}

}  // namespace beambench::embree

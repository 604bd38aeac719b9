#pragma once
// Queries of Embree 3. Included by api.hpp only.

#include <embree3/rtcore.h>

namespace beambench::accel::embree {

using RawContext = RTCIntersectContext;

/// The context passed by Embree to user geometry; derive from it to carry the state of a query.
struct Context : RawContext {
  explicit Context(bool coherent) {
    rtcInitIntersectContext(this);
    flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }
};

inline void intersect(RTCScene scene, Context& context, RTCRayHit& query) {
  rtcIntersect1(scene, &context, &query);
}
inline void intersect(const int* valid, RTCScene scene, Context& context, RTCRayHit4& query) {
  rtcIntersect4(valid, scene, &context, &query);
}
inline void intersect(const int* valid, RTCScene scene, Context& context, RTCRayHit8& query) {
  rtcIntersect8(valid, scene, &context, &query);
}
inline void intersect(const int* valid, RTCScene scene, Context& context, RTCRayHit16& query) {
  rtcIntersect16(valid, scene, &context, &query);
}
inline void intersect_any(RTCScene scene, Context& context, RTCRay& ray) {
  rtcOccluded1(scene, &context, &ray);
}
inline void intersect_any(const int* valid, RTCScene scene, Context& context, RTCRay4& rays) {
  rtcOccluded4(valid, scene, &context, &rays);
}
inline void intersect_any(const int* valid, RTCScene scene, Context& context, RTCRay8& rays) {
  rtcOccluded8(valid, scene, &context, &rays);
}
inline void intersect_any(const int* valid, RTCScene scene, Context& context, RTCRay16& rays) {
  rtcOccluded16(valid, scene, &context, &rays);
}

/// Traces a stream of packets (RTCRayHit4, 8 or 16) in one call; rays with tfar < tnear are
/// skipped.
template <class Packet>
void intersect_stream(RTCScene scene, Context& context, Packet* packets, unsigned count) {
  constexpr unsigned kLanes = sizeof(packets->ray.tfar) / sizeof(float);
  rtcIntersectNM(scene, &context, reinterpret_cast<RTCRayHitN*>(packets), kLanes, count,
                 sizeof(Packet));
}

/// Traces a stream of any-hit packets (RTCRay4, 8 or 16).
template <class Rays>
void intersect_any_stream(RTCScene scene, Context& context, Rays* packets, unsigned count) {
  constexpr unsigned kLanes = sizeof(packets->tfar) / sizeof(float);
  rtcOccludedNM(scene, &context, reinterpret_cast<RTCRayN*>(packets), kLanes, count, sizeof(Rays));
}

}  // namespace beambench::accel::embree

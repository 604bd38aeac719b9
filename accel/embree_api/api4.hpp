#pragma once
// Queries of Embree 4, which has no streams. Included by api.hpp only.

#include <embree4/rtcore.h>

namespace beambench::accel::embree {

using RawContext = RTCRayQueryContext;

/// The context passed by Embree to user geometry; derive from it to carry the state of a query. It
/// also holds a query's arguments, which are set up once rather than for every ray.
struct Context : RawContext {
  explicit Context(bool coherent) {
    rtcInitRayQueryContext(this);
    rtcInitIntersectArguments(&closest);
    rtcInitOccludedArguments(&any);
    closest.context = any.context = this;
    closest.flags = any.flags =
        coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context() = default;

  RTCIntersectArguments closest;
  RTCOccludedArguments any;
};

inline void intersect(RTCScene scene, Context& context, RTCRayHit& query) {
  rtcIntersect1(scene, &query, &context.closest);
}
inline void intersect(const int* valid, RTCScene scene, Context& context, RTCRayHit4& query) {
  rtcIntersect4(valid, scene, &query, &context.closest);
}
inline void intersect(const int* valid, RTCScene scene, Context& context, RTCRayHit8& query) {
  rtcIntersect8(valid, scene, &query, &context.closest);
}
inline void intersect(const int* valid, RTCScene scene, Context& context, RTCRayHit16& query) {
  rtcIntersect16(valid, scene, &query, &context.closest);
}
inline void intersect_any(RTCScene scene, Context& context, RTCRay& ray) {
  rtcOccluded1(scene, &ray, &context.any);
}
inline void intersect_any(const int* valid, RTCScene scene, Context& context, RTCRay4& rays) {
  rtcOccluded4(valid, scene, &rays, &context.any);
}
inline void intersect_any(const int* valid, RTCScene scene, Context& context, RTCRay8& rays) {
  rtcOccluded8(valid, scene, &rays, &context.any);
}
inline void intersect_any(const int* valid, RTCScene scene, Context& context, RTCRay16& rays) {
  rtcOccluded16(valid, scene, &rays, &context.any);
}

}  // namespace beambench::accel::embree

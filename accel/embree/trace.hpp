#pragma once
// A whole image through Embree, in each of the ways it takes rays.

#include <span>

#include "accel/embree/native_scene.hpp"
#include "accel/hit_buffer.hpp"
#include "accel/primary_rays.hpp"

namespace beambench::embree {

/// A way to trace the closest hits of an image, by exactly the rays of `PrimaryRays::ray`.
struct TraceMode {
  const char* name;
  void (*trace)(const NativeScene& scene, Context& context, const PrimaryRays& rays,
                HitBuffer& buffer);
};

/// The ways that the Embree we were built with has, the simplest first.
std::span<const TraceMode> trace_modes();

}  // namespace beambench::embree

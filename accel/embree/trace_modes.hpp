#pragma once
// A whole image or a list of rays through Embree, in each of the ways it takes rays.

#include <cstdint>
#include <span>

#include "accel/embree/image_tracers.hpp"

namespace beambench::accel::embree {

/// A way to ask Embree: for the closest hits of an image, and for closest or any hits of a list of
/// rays.
struct TraceMode {
  const char* name;
  ImageTracers::Trace ImageTracers::*trace;
  void (*closest_hits)(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                       HitBuffer& buffer);
  void (*any_hits)(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                   std::span<std::uint8_t> answers);
};

/// The ways that the Embree we were built with has, the simplest first.
std::span<const TraceMode> trace_modes();

}  // namespace beambench::accel::embree

#pragma once
// A whole image or a list of rays through Embree, in each of its query modes.

#include <cstdint>
#include <span>

#include "accel/embree/image_tracers.hpp"

namespace beambench::accel::embree {

/// A query mode of Embree: for the closest hits of an image, and for closest or any hits of a list
/// of rays. In a list, packets are of neighbors; the last one may have idle lanes.
struct TraceMode {
  const char* name;
  ImageTracers::Trace ImageTracers::*trace;
  void (*closest_hits)(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                       HitBuffer& buffer);
  void (*any_hits)(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                   std::span<std::uint8_t> answers);
};

/// The modes of the Embree version that the program was built with, the simplest first.
std::span<const TraceMode> trace_modes();

}  // namespace beambench::accel::embree

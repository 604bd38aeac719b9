#pragma once
// A whole image through Embree, in each of the ways it takes rays.

#include "accel/embree/native_scene.hpp"
#include "accel/hit_buffer.hpp"
#include "accel/primary_rays.hpp"

namespace beambench::embree {

enum class TraceMode { kSingle, kPacket4, kPacket8, kPacket16, kStream };

/// Traces the closest hits of an image. Every mode shoots exactly the rays of `PrimaryRays::ray`.
void trace(const NativeScene& scene, TraceMode mode, bool coherent, const PrimaryRays& rays,
           HitBuffer& buffer);

}  // namespace beambench::embree

#pragma once
// A list of rays through Embree: one by one, or in packets of neighbors in the list.

#include <cstdint>
#include <span>

#include "accel/core/hit_buffer.hpp"
#include "accel/embree/native_scene.hpp"

namespace beambench::accel::embree {

void closest_hits_single(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                         HitBuffer& buffer);
void any_hits_single(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                     std::span<std::uint8_t> answers);

/// N is 4, 8 or 16; what is left at the end of the list goes in a packet with idle lanes.
template <int N>
void closest_hits_by_packets(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                             HitBuffer& buffer);
template <int N>
void any_hits_by_packets(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                         std::span<std::uint8_t> answers);

}  // namespace beambench::accel::embree

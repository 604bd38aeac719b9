#pragma once
// Traces lists of rays with Embree. Packets are filled and results are stored by SIMD, compiled for
// several instruction sets, so that measurements show Embree and not the packing of rays.

#include <cstdint>
#include <span>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/ray.hpp"
#include "accel/embree/native_scene.hpp"

namespace beambench::accel::embree {

/// The two queries of a list, in one of Embree's modes. Packets consist of neighbors in the list;
/// the last one may have idle lanes.
struct ListMode {
  void (*closest_hits)(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                       const HitSpan& buffer);
  void (*any_hits)(const NativeScene& scene, Context& context, std::span<const Ray> rays,
                   std::span<std::uint8_t> answers);
};

/// The list tracers for one instruction set.
struct ListTracers {
  ListMode single;  ///< ray by ray
  ListMode packet4;
  ListMode packet8;
  ListMode packet16;
  /// 256 rays at a time, in packets as wide as the instruction set's registers, because Embree
  /// would first copy packets of any other width. nullptr in Embree 4.
  ListMode stream;
  /// Fill packets of 16 and store a miss for each ray, without a query.
  void (*untraced_closest)(const OwnerTable& owners, std::span<const Ray> rays,
                           const HitSpan& buffer);
  void (*untraced_any)(std::span<const Ray> rays, std::span<std::uint8_t> answers);
};

/// Returns the tracers for the best of Highway's `targets` that this machine supports.
const ListTracers& list_tracers(std::int64_t targets);

}  // namespace beambench::accel::embree

// Prefetches parts of a hierarchy.

#if defined(ACCEL_TILE_BEAM_PREFETCH_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_PREFETCH_INL
#undef ACCEL_TILE_BEAM_PREFETCH_INL
#else
#define ACCEL_TILE_BEAM_PREFETCH_INL
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/cache_control.h>

#include "accel/tile_beam/lanes-inl.hpp"
#include "accel/tile_beam/tile_hierarchy.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Prefetches cache lines. Must be inlined before GCC looks for functions without side effects: it
/// takes a function that only prefetches for one of these and removes its calls.
HWY_INLINE void prefetch_lines(const void* from, std::size_t bytes) {
  const auto* const first = static_cast<const std::uint8_t*>(from);
  for (std::size_t i = 0; i < bytes; i += 64) hwy::Prefetch(first + i);
}

/// Prefetches a whole child of a node for a beam. Entries on a stack are visited soon, in an order
/// that the processor cannot predict.
HWY_INLINE void prefetch_child(const TileHierarchy& hierarchy, TileChild child) {
  if (child.kind() == TileChild::Kind::kNode) {
    prefetch_lines(&hierarchy.nodes[child.index()], sizeof(TileNode));
  } else if (child.kind() == TileChild::Kind::kMeshlet) {
    prefetch_lines(&hierarchy.meshlets[child.index()], sizeof(Meshlet));
  }
}

/// Prefetches the data for the next step of a single ray.
HWY_INLINE void prefetch_for_ray(const TileHierarchy& hierarchy, TileChild child) {
  if (child.kind() == TileChild::Kind::kNode) {
    const TileNode& node = hierarchy.nodes[child.index()];
    prefetch_lines(&node.boxes, sizeof(node.boxes));
    prefetch_lines(&node.children, sizeof(node.children));
    prefetch_lines(&node.count, sizeof(node.count));
  } else {
    prefetch_child(hierarchy, child);
  }
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

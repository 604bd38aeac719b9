#pragma once
// Sorts boxes along a Morton curve.

#include <cstdint>
#include <span>

#include "accel/core/unset_pages.hpp"
#include "scenes/bounds.hpp"

namespace beambench::accel::bvh {

/// A box with the Morton code of its center: the code in the upper half, its index in the lower.
using MortonKey = std::uint64_t;

inline std::uint32_t code_of(MortonKey key) { return static_cast<std::uint32_t>(key >> 32U); }
inline std::uint32_t index_of(MortonKey key) { return static_cast<std::uint32_t>(key); }

/// Returns a key for each box, sorted. Codes have 30 bits. Each bit halves the cell's longest side
/// (Vinkler, Bittner and Havran, "Extended Morton codes for high performance bounding volume
/// hierarchy construction", 2017), so that a flat scene is not divided across its thickness.
/// `parallel`: use all cores; the result is the same.
UnsetLargePageVector<MortonKey> morton_order(std::span<const scenes::Bounds> boxes, bool parallel);

}  // namespace beambench::accel::bvh

#pragma once
// The memory of a stream: its rays, their lists and their hits.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "accel/core/large_pages.hpp"
#include "accel/core/ray.hpp"

namespace beambench::accel::bvh {

/// The number for "no triangle"; other numbers are indices into `StreamTree::triangles`.
inline constexpr std::uint32_t kNoTriangle = ~std::uint32_t{0};

/// The nearest triangle that a ray certainly hits.
struct StreamHit {
  float t_low = kInfinity;  ///< lower bound of the hit's t
  std::uint32_t triangle = kNoTriangle;
};

/// A ray and a triangle that it may hit.
struct StreamPair {
  std::uint32_t ray;
  std::uint32_t triangle;
};

/// The memory of a stream. Each thread reuses it from one stream to the next, because allocating
/// new memory takes as long as the traversal.
struct StreamMemory {
  /// The maximum number of rays in a packet, and the entries that may be written past a list's end.
  static constexpr std::size_t kPacket = 16;
  /// A node's lists take eight entries for each of its rays; the lists of all nodes above it
  /// usually need less than half of `kEntriesPerRay`. Lists that do not fit continue as packets.
  static constexpr std::size_t kEntriesPerRay = 32;

  LargePageVector<Ray> rows;             ///< t_max: only nearer hits count
  LargePageVector<std::uint32_t> lists;  ///< offsets of rows, in bytes
  LargePageVector<StreamHit> hits;       ///< the nearest hit of each ray
  std::vector<StreamPair> doubts;        ///< pairs left to the canonical test

  /// Returns how many entries of `lists` a stream may use. The number does not depend on the memory
  /// left by earlier streams, so neither do the counters.
  static constexpr std::size_t entries_for(std::size_t rays) {
    return kEntriesPerRay * (rays + 4 * kPacket);
  }

  void reserve(std::size_t rays) {
    const std::size_t entries = entries_for(rays);
    if (rows.size() < rays) {
      rows.resize(rays);
      hits.resize(rays);
    }
    if (lists.size() < entries) lists.resize(entries);
  }

  static StreamMemory& of_thread() {
    thread_local StreamMemory memory;
    return memory;
  }
};

}  // namespace beambench::accel::bvh

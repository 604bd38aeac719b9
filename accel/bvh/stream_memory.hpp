#pragma once
// The memory of a stream: its rays, its lists and their hits.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "accel/core/large_pages.hpp"
#include "accel/core/ray.hpp"

namespace beambench::accel::bvh {

/// The number for "no triangle"; others are indices into `StreamTree::triangles`.
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

/// Each thread keeps this from one stream to the next, because new memory costs as much as the
/// traversal.
struct StreamMemory {
  /// The maximum number of rays in a packet, and the entries that may be written past a list's end.
  static constexpr std::size_t kPacket = 16;
  /// A node's lists take eight entries for each of its rays; all entries of the nodes above it
  /// usually need less than half of these. Lists that do not fit continue as packets.
  static constexpr std::size_t kEntriesPerRay = 32;

  LargePageVector<Ray> rows;             ///< t_max: only nearer hits count
  LargePageVector<std::uint32_t> lists;  ///< offsets of rows, in bytes
  LargePageVector<StreamHit> hits;       ///< of each ray
  std::vector<StreamPair> doubts;        ///< to be tested

  /// Returns how many entries of `lists` a stream may use; not all that an earlier stream needed,
  /// so that counters do not depend on it.
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

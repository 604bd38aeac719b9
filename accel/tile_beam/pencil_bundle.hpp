#pragma once
// The pencils of one extended light: results common to all of them are found once.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/bvh/stream_kernels.hpp"
#include "accel/core/ray.hpp"
#include "accel/core/ray_batch.hpp"
#include "accel/tile_beam/pencil_kernels.hpp"

namespace beambench::accel::tile_beam {

/// Returns whether pencils are a bundle as `PencilBundle` describes it, as far as this can be
/// determined without examining their rays.
bool is_bundle(std::span<const Pencil> pencils);

/// Some origins of a bundle of at most BundleRays::kApexes pencils: `count` of each pencil's rays,
/// from its ray `first` on.
struct BundlePart {
  /// The maximum number of origins traced at once.
  static constexpr std::size_t kOrigins = 16 * PencilUnit::kRays;

  const TileHierarchy& hierarchy;
  const scenes::Scene& scene;
  const PencilKernels& kernels;
  std::span<const Ray> rays;  ///< of the batch
  PencilSamples samples;      ///< likewise
  std::span<const Pencil> pencils;
  std::size_t first;
  std::size_t count;  ///< at most kOrigins
};

/// Memory for one thread.
struct BundleMemory {
  std::vector<std::uint32_t> found;  ///< for each origin, the hidden apexes, or kOpen
  std::vector<std::uint32_t> open;   ///< the open origins
  std::vector<Ray> rays;             ///< the rays from open origins, origin by origin
  std::vector<std::uint8_t> hits;    ///< of these rays
};

/// Writes 0 or 1 for each ray of the batch that belongs to the part, except for rays from origins
/// that it leaves open. Returns false, having written nothing, if most of the first origins are
/// open: the light is inside a lamp, and nearby surfaces may block all rays.
template <class Counting>
bool find_hidden(const BundlePart& part, PencilUnit& unit, BundleMemory& memory,
                 std::span<std::uint8_t> hits, Counting& counting);

/// Calls `trace(rays, hits)` for lists of rays from the open origins, and copies the results.
template <class Trace>
void trace_open(const BundlePart& part, BundleMemory& memory, std::span<std::uint8_t> hits,
                const Trace& trace) {
  constexpr std::size_t kAtOnce = bvh::Stream::kMostRays / BundleRays::kApexes;
  const std::size_t apexes = part.pencils.size();
  for (std::size_t first = 0; first < memory.open.size(); first += kAtOnce) {
    const auto open = std::span<const std::uint32_t>(memory.open).subspan(first);
    const std::size_t count = std::min(kAtOnce, open.size());
    memory.rays.resize(count * apexes);
    memory.hits.resize(count * apexes);
    const auto for_each = [&](const auto& visit) {
      for (std::size_t apex = 0; apex < apexes; ++apex) {
        const std::size_t begin = part.pencils[apex].first + part.first;
        for (std::size_t i = 0; i < count; ++i) visit(begin + open[i], i * apexes + apex);
      }
    };
    for_each([&](std::size_t ray, std::size_t place) { memory.rays[place] = part.rays[ray]; });
    trace(std::span<const Ray>(memory.rays), std::span(memory.hits));
    for_each([&](std::size_t ray, std::size_t place) { hits[ray] = memory.hits[place]; });
  }
}

}  // namespace beambench::accel::tile_beam

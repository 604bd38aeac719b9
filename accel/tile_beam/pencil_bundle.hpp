#pragma once
// The pencils of one light with an extent: what is the same for all of them is found once.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/ray.hpp"
#include "accel/core/ray_batch.hpp"
#include "accel/tile_beam/pencil_kernels.hpp"

namespace beambench::accel::tile_beam {

/// A ball that holds the apexes of a bundle, up to what rounding changes of rays toward them.
struct ApexBall {
  glm::vec3 center;
  float radius;

  ApexBall(std::span<const Pencil> pencils, const scenes::Bounds& scene);
};

/// Returns whether pencils are a bundle as `PencilBundle` describes it, as far as that can be seen
/// without looking at their rays.
bool is_bundle(std::span<const Pencil> pencils);

/// Some origins of a bundle: `count` of each pencil's rays, from its ray `first` on.
struct BundlePart {
  /// Origins that are traced at once.
  static constexpr std::size_t kOrigins = 4 * PencilUnit::kRays;

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
  PencilUnit unit;
  std::vector<std::uint8_t> found;       ///< of each origin: 0, 1 or kUndecided
  std::vector<std::uint32_t> open;       ///< the undecided origins
  std::vector<std::uint32_t> samples;    ///< of these
  std::vector<Ray> rays;                 ///< from these
  std::vector<std::uint8_t> open_found;  ///< of their rays
};

/// Traces a part: first all origins against the ball of apexes, then, pencil by pencil, the rays
/// from those that this left open. Writes 0, 1 or kUndecided for each ray of the batch that belongs
/// to the part.
template <class Counting>
void trace_bundle(const BundlePart& part, BundleMemory& memory, std::span<std::uint8_t> hits,
                  Counting& counting);

}  // namespace beambench::accel::tile_beam

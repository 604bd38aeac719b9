#pragma once
// A whole image, tile by tile.

#include "accel/core/hit_buffer.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/tile_beam/tile_hierarchy.hpp"
#include "accel/tile_beam/tile_kernels.hpp"

namespace beambench::accel::tile_beam {

/// Finds the closest hits of `rays`. `parallel`: tiles are shared among all cores; hits and counts
/// are the same. `Counting` is NoCounting or WorkCounters.
template <class Counting>
void trace_tiles(const TileKernels& kernels, const TileHierarchy& hierarchy,
                 const scenes::Scene& scene, const PrimaryRays& rays, bool parallel,
                 HitBuffer& buffer, Counting& counting);

}  // namespace beambench::accel::tile_beam

#pragma once
// Reflections in planar mirrors, seen from virtual eyes.

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/core/ray_batch.hpp"
#include "scenes/planar_mirrors.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::beam {

/// The view in a mirror: the rays that the mirror reflects.
struct MirrorView {
  PrimaryRays image;  ///< seen from the virtual eye
  glm::dvec3 apex;    ///< the common point of the rays' lines
  std::vector<Ray> rays;
  std::vector<std::uint32_t> samples;  ///< of the image, one for each ray

  /// Returns all rays as one pencil.
  Pencil pencil() const { return {0, rays.size(), apex, false, &image}; }
};

/// Returns the rays that a mirror reflects, from the hits of an image. Returns nothing if no ray
/// hits it.
std::optional<MirrorView> view_in(const scenes::PlanarSurface& mirror, const PrimaryRays& rays,
                                  const HitBuffer& hits);

}  // namespace beambench::accel::beam

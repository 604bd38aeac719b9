#pragma once
// What planar mirrors show, by virtual eyes.

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

/// What the eye sees in a mirror: the rays that the mirror sends on.
struct MirrorView {
  PrimaryRays image;  ///< of the virtual eye
  glm::dvec3 apex;    ///< through which the rays' lines pass
  std::vector<Ray> rays;
  std::vector<std::uint32_t> samples;  ///< of the image, for each ray

  /// All rays as one pencil.
  Pencil pencil() const { return {0, rays.size(), apex, false, &image}; }
};

/// From the hits of an image: the rays that a mirror sends on. Nothing where none see it.
std::optional<MirrorView> view_in(const scenes::PlanarMirror& mirror, const PrimaryRays& rays,
                                  const HitBuffer& hits);

}  // namespace beambench::accel::beam

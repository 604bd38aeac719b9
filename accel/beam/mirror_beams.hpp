#pragma once
// Beams of reflected rays: what planar mirrors show, by virtual eyes.

#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/beam/beam_tracer.hpp"
#include "scenes/planar_mirrors.hpp"

namespace beambench::accel::beam {

/// What the eye sees in a mirror.
struct MirrorView {
  BehindMirror sight;
  PrimaryRays rays;     ///< of the virtual eye
  std::size_t samples;  ///< that see the mirror
};

/// From the hits of an image: the virtual eye of a mirror, and a convex cover of the samples that
/// see it. Nothing where none do.
std::optional<MirrorView> view_in(const scenes::PlanarMirror& mirror, const scenes::Scene& scene,
                                  const PrimaryRays& rays, const HitBuffer& hits);

/// A sample's ray behind the mirror, as the beams trace it.
Ray ray_behind(const MirrorView& view, int x, int y, int sample);

}  // namespace beambench::accel::beam

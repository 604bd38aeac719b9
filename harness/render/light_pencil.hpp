#pragma once
// The shadow rays of an image toward one light, and their places in a structure's beams.

#include <cstdint>
#include <vector>

#include "accel/core/accelerator.hpp"
#include "scenes/scene.hpp"

namespace beambench::render {

/// The shadow rays of one light; each vector has one element for each ray.
struct LightPencil {
  std::vector<accel::Ray> rays;          ///< from the surface; the light is at t = 1
  std::vector<std::uint32_t> samples;    ///< of the image, as numbered by a HitBuffer
  std::vector<accel::BeamPlace> places;  ///< empty if the structure has no blocks of rays
};

/// Returns the pencil of one of the scene's lights among the shadow rays of an image; without rays
/// if no hit faces the light.
LightPencil light_pencil(const accel::Accelerator& accelerator, const scenes::Scene& scene,
                         const accel::PrimaryRays& image, const scenes::Light& light);

}  // namespace beambench::render

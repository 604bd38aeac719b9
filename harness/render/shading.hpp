#pragma once
// From the hits of an image to a picture.

#include <span>
#include <string_view>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/primary_rays.hpp"
#include "harness/render/picture/image.hpp"
#include "scenes/scene.hpp"

namespace beambench::render {

/// What a picture shows of a hit.
enum class Shading {
  kPreview,  ///< surface colors under the scene's lights and a headlight, without shadows
  kNormals,  ///< the surface's direction: x, y, z as red, green, blue
  kId,       ///< a color for each primitive
  kDepth,    ///< the nearer, the brighter
  kWhitted   ///< the whole ray tracer (`Whitted`), which needs more than hits
};

/// The names after --shade, in the order of `Shading`.
std::span<const std::string_view> shading_names();
/// Throws InputError listing the valid names.
Shading parse_shading(std::string_view name);

/// Each pixel is the mean of its samples. `hits` are the answers to `rays`. Throws
/// std::invalid_argument for kWhitted.
Image shade(const scenes::Scene& scene, const accel::PrimaryRays& rays,
            const accel::HitBuffer& hits, Shading shading);

}  // namespace beambench::render

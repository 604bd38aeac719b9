#pragma once
// The data of a page: a scene, and the work of structures over it.

#include <functional>
#include <span>

#include <nlohmann/json.hpp>

#include "accel/core/registry.hpp"
#include "harness/rays/trace_input.hpp"
#include "scenes/scene.hpp"

namespace beambench::explain {

/// The maximum number of pixels of the image whose rays a page follows.
inline constexpr std::size_t kMostPixels = 65'536;

/// Returns the default resolution of the image whose rays a page follows: 96 pixels along its
/// longer side.
rays::Resolution default_resolution(const scenes::Camera& camera);

/// Builds one or two structures and follows the rays of an image, one per pixel (its first sample),
/// through each. The result contains the scene and, for each structure, its statistics, cells,
/// paths, beams and pencils; all arrays are in one string (`PackedArrays`). Calls `advance` from
/// time to time with the fraction done; it may throw. Throws InputError if the image has more than
/// `kMostPixels` pixels or the number of structures is not one or two, and InvalidHit if a
/// structure returns an impossible hit.
nlohmann::json explain(
    const scenes::Scene& scene, const rays::ImageOfRays& image,
    std::span<const accel::StructureChoice> structures,
    const std::function<void(double)>& advance = [](double) {});

}  // namespace beambench::explain

#pragma once
// What a page shows: a scene, and the work of structures over it, as data.

#include <functional>
#include <span>

#include <nlohmann/json.hpp>

#include "accel/core/registry.hpp"
#include "harness/rays/trace_input.hpp"
#include "scenes/scene.hpp"

namespace beambench::explain {

/// The most pixels of the image whose rays a page follows.
inline constexpr std::size_t kMostPixels = 65'536;

/// Returns the image of a camera whose rays a page follows by default: 96 pixels along its longer
/// side.
rays::Resolution default_resolution(const scenes::Camera& camera);

/// Builds each structure, of which there are one or two, and follows the rays of an image through
/// it: the first sample of each pixel. The result holds the scene, and for each structure its
/// statistics, cells, paths, beams and pencils; arrays are in one text (`PackedArrays`). `advance`
/// is called now and then with the share that is done, and may throw. Throws InputError if the
/// image has more than `kMostPixels` pixels or there are other numbers of structures, InvalidHit if
/// a structure returns an impossible hit.
nlohmann::json explain(
    const scenes::Scene& scene, const rays::ImageOfRays& image,
    std::span<const accel::StructureChoice> structures,
    const std::function<void(double)>& advance = [](double) {});

}  // namespace beambench::explain

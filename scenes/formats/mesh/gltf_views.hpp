#pragma once
// Cameras and lights of a glTF file.

#include <span>
#include <string>
#include <vector>

#include <tiny_gltf.h>

#include "scenes/bounds.hpp"
#include "scenes/camera.hpp"
#include "scenes/formats/mesh/gltf_nodes.hpp"
#include "scenes/scene.hpp"

namespace beambench::scenes::mesh {

/// Returns the perspective cameras, looking at the depth of the center of `bounds`. Each has the
/// name of its node, or else its own, or else `camera`, without control characters and '#',
/// followed by a number if an earlier camera or a fitted one (`fitted_camera_names`) has that name.
/// Cameras that are orthographic, or invalid in a scene, are left out with a warning.
std::vector<Camera> gltf_cameras(const tinygltf::Model& model, std::span<const PlacedNode> nodes,
                                 const Bounds& bounds, std::vector<std::string>& warnings);

/// Returns the lights of KHR_lights_punctual. Scene lights do not fall off, so each has the
/// brightness that it has at the center of `bounds`: a point light's intensity over its squared
/// distance (at least a tenth of the radius), a directional light's intensity. All are scaled by
/// one factor, so that the squares of their brightest components sum to 1, as for a scene's white
/// lights. A directional light becomes a distant point, and a spot shines in all directions; a
/// warning reports this.
std::vector<Light> gltf_lights(const tinygltf::Model& model, std::span<const PlacedNode> nodes,
                               const Bounds& bounds, std::vector<std::string>& warnings);

}  // namespace beambench::scenes::mesh

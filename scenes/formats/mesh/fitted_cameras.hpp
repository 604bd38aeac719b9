#pragma once
// Cameras that see all of a mesh.

#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/camera.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"

namespace beambench::scenes::mesh {

/// Returns standard views of these points, as in modelling programs: `three-quarter` (from the
/// front, the right and above), `front`, `side` (from the right) and `top`. Each shows all points
/// and fills a frustum of 45 degrees with them, except for a small margin. Returns no views if
/// there are no points, or if an eye would be beyond the limit of coordinates.
std::vector<Camera> fitted_cameras(std::span<const glm::vec3> points,
                                   const Orientation& orientation);

/// The names that these views have.
std::vector<std::string> fitted_camera_names();

}  // namespace beambench::scenes::mesh

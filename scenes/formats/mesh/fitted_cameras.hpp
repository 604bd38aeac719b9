#pragma once
// Cameras that see all of a mesh.

#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/camera.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"

namespace beambench::scenes::mesh {

/// Standard views of these points, as in modelling programs: `three-quarter` (from in front, the
/// right and above), `front`, `side` (from the right) and `top`. Each sees all points and fills the
/// frustum of 45 degrees with them, but for a small margin. None where there is no point, or where
/// an eye would be beyond the limit of coordinates.
std::vector<Camera> fitted_cameras(std::span<const glm::vec3> points,
                                   const Orientation& orientation);

/// The names that these views have.
std::vector<std::string> fitted_camera_names();

}  // namespace beambench::scenes::mesh

#pragma once
// Cameras that see the whole mesh.

#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/camera.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"

namespace beambench::scenes::mesh {

/// Returns standard views of these points, as in modeling programs: `three-quarter` (from the
/// front, the right and above), `front`, `side` (from the right) and `top`. Each fills a frustum of
/// 45 degrees with the points, apart from a narrow margin. Returns no views if there are no points,
/// or if an eye would be beyond the limit of coordinates.
std::vector<Camera> fitted_cameras(std::span<const glm::vec3> points,
                                   const Orientation& orientation);

/// Returns the names of these views.
std::vector<std::string> fitted_camera_names();

}  // namespace beambench::scenes::mesh

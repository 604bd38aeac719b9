#pragma once
// Scenes from arrays of coordinates.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/formats/mesh/mesh_file.hpp"
#include "scenes/scene.hpp"

namespace beambench::python {

/// Flat triangles in their order, with the cameras and lights of mesh files. Throws InputError as
/// SceneBuilder.
scenes::Scene triangle_scene(const std::string& name, std::span<const glm::dvec3> vertices,
                             std::span<const std::array<std::uint32_t, 3>> triangles,
                             const scenes::mesh::Orientation& orientation);

/// The places of triangles that no scene can have: after rounding they have no area. The indices
/// are those of vertices.
std::vector<std::uint32_t> triangles_without_area(
    std::span<const glm::dvec3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles);

/// Spheres in their order, with the same cameras and lights. There are as many radii as centers.
scenes::Scene sphere_scene(const std::string& name, std::span<const glm::dvec3> centers,
                           std::span<const double> radii,
                           const scenes::mesh::Orientation& orientation);

}  // namespace beambench::python

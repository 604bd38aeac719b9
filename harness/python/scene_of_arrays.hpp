#pragma once
// Builds scenes from arrays of coordinates.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/formats/mesh/mesh.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"
#include "scenes/scene.hpp"

namespace beambench::python {

/// Returns triangles over vertices, rounded to float once, with one surface.
scenes::mesh::TriangleMesh mesh_of(std::span<const glm::dvec3> vertices,
                                   std::span<const std::array<std::uint32_t, 3>> triangles);

/// Returns the places of triangles that no scene can have, because they have no area after
/// rounding. `indices` are those of vertices.
std::vector<std::uint32_t> triangles_without_area(
    std::span<const glm::dvec3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles);

/// Returns spheres in order, with the same kinds of cameras and lights as for meshes. The numbers
/// of radii and centers must be equal. Throws InputError as SceneBuilder.
scenes::Scene sphere_scene(const std::string& name, std::span<const glm::dvec3> centers,
                           std::span<const double> radii,
                           const scenes::mesh::Orientation& orientation);

}  // namespace beambench::python

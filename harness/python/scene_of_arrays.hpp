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

/// Returns the mesh of triangles over the vertices, which are rounded to float once, with a single
/// surface.
scenes::mesh::TriangleMesh mesh_of(std::span<const glm::dvec3> vertices,
                                   std::span<const std::array<std::uint32_t, 3>> triangles);

/// Returns the indices of triangles that cannot be in a scene, because they have no area after
/// rounding. `indices` refer to vertices.
std::vector<std::uint32_t> triangles_without_area(
    std::span<const glm::dvec3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles);

/// Returns a scene of spheres, in order, with the same kinds of cameras and lights as meshes have.
/// There must be as many radii as centers. Throws what SceneBuilder throws.
scenes::Scene sphere_scene(const std::string& name, std::span<const glm::dvec3> centers,
                           std::span<const double> radii,
                           const scenes::mesh::Orientation& orientation);

}  // namespace beambench::python

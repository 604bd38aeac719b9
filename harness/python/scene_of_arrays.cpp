#include "harness/python/scene_of_arrays.hpp"

#include <utility>

#include <glm/common.hpp>

#include "scenes/formats/mesh/fitted_cameras.hpp"
#include "scenes/formats/mesh/mesh_scene.hpp"
#include "scenes/scene_builder.hpp"
#include "scenes/triangulate.hpp"

namespace beambench::python {

scenes::mesh::TriangleMesh mesh_of(std::span<const glm::dvec3> vertices,
                                   std::span<const std::array<std::uint32_t, 3>> triangles) {
  scenes::mesh::TriangleMesh mesh;
  mesh.vertices.assign(vertices.begin(), vertices.end());
  mesh.triangles.assign(triangles.begin(), triangles.end());
  mesh.parts.push_back({{}, static_cast<std::uint32_t>(triangles.size())});
  return mesh;
}

std::vector<std::uint32_t> triangles_without_area(
    std::span<const glm::dvec3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles) {
  std::vector<std::uint32_t> found;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto corner = [&](std::size_t j) { return glm::vec3(vertices[triangles[i][j]]); };
    if (!scenes::has_area(corner(0), corner(1), corner(2))) {
      found.push_back(static_cast<std::uint32_t>(i));
    }
  }
  return found;
}

scenes::Scene sphere_scene(const std::string& name, std::span<const glm::dvec3> centers,
                           std::span<const double> radii,
                           const scenes::mesh::Orientation& orientation) {
  scenes::SceneBuilder builder(name);
  scenes::Bounds bounds;
  for (std::size_t i = 0; i < centers.size(); ++i) {
    builder.add_sphere(centers[i], radii[i]);
    const glm::dvec3 extent(glm::abs(radii[i]));
    bounds.include(glm::vec3(centers[i] - extent));
    bounds.include(glm::vec3(centers[i] + extent));
  }
  std::vector<glm::vec3> corners;
  for (const float x : {bounds.lower.x, bounds.upper.x}) {
    for (const float y : {bounds.lower.y, bounds.upper.y}) {
      for (const float z : {bounds.lower.z, bounds.upper.z}) corners.emplace_back(x, y, z);
    }
  }
  scenes::mesh::add_view(builder, corners, orientation);
  return std::move(builder).build();
}

}  // namespace beambench::python

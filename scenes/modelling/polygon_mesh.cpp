#include "scenes/modelling/polygon_mesh.hpp"

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

namespace beambench::scenes::modelling {

void append(PolygonMesh& mesh, const PolygonMesh& more) {
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  mesh.polygons.reserve(mesh.polygons.size() + more.polygons.size());
  for (const PolygonMesh::Corners& corners : more.polygons) {
    PolygonMesh::Corners& added = mesh.polygons.emplace_back(corners);
    for (std::uint32_t& corner : added) corner += offset;
  }
}

PolygonMesh transformed(PolygonMesh mesh, const glm::dmat4& transform) {
  for (glm::dvec3& vertex : mesh.vertices) {
    vertex = glm::dvec3(transform * glm::dvec4(vertex, 1.0));
  }
  const bool mirrors = glm::determinant(glm::dmat3(transform)) < 0.0;
  return mirrors ? turned_inside_out(std::move(mesh)) : mesh;
}

PolygonMesh turned_inside_out(PolygonMesh mesh) {
  for (PolygonMesh::Corners& corners : mesh.polygons) std::reverse(corners.begin(), corners.end());
  return mesh;
}

glm::dvec3 area_normal(const PolygonMesh& mesh, const PolygonMesh::Corners& corners) {
  const glm::dvec3 first = mesh.vertices[corners.front()];
  glm::dvec3 sum(0.0);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    sum += glm::cross(mesh.vertices[corners[i]] - first, mesh.vertices[corners[i + 1]] - first);
  }
  return sum;
}

}  // namespace beambench::scenes::modelling

#include "scenes/modelling/add_mesh.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "scenes/base/portable_math.hpp"

namespace beambench::scenes::modelling {
namespace {

std::vector<std::uint32_t> add_vertices(SceneBuilder& builder, const PolygonMesh& mesh) {
  std::vector<std::uint32_t> index;
  index.reserve(mesh.vertices.size());
  for (const glm::dvec3& vertex : mesh.vertices) index.push_back(builder.add_vertex(vertex));
  return index;
}

PolygonMesh::Corners renumbered(PolygonMesh::Corners corners,
                                const std::vector<std::uint32_t>& index) {
  for (std::uint32_t& corner : corners) corner = index[corner];
  return corners;
}

}  // namespace

void add_flat(SceneBuilder& builder, const PolygonMesh& mesh) {
  const std::vector<std::uint32_t> index = add_vertices(builder, mesh);
  for (const auto& corners : mesh.polygons) builder.add_polygon(renumbered(corners, index));
}

void add_painted(SceneBuilder& builder, const PolygonMesh& mesh, const Paint& paint) {
  const std::vector<std::uint32_t> index = add_vertices(builder, mesh);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    builder.set_surface(paint(i));
    builder.add_polygon(renumbered(mesh.polygons[i], index));
  }
}

void add_smooth(SceneBuilder& builder, const PolygonMesh& mesh, const SmoothOptions& options) {
  const std::vector<std::uint32_t> index = add_vertices(builder, mesh);
  std::vector<glm::dvec3> areas;
  std::vector<std::vector<std::uint32_t>> around(mesh.vertices.size());
  for (const auto& corners : mesh.polygons) {
    for (const std::uint32_t corner : corners) {
      around[corner].push_back(static_cast<std::uint32_t>(areas.size()));
    }
    areas.push_back(area_normal(mesh, corners));
  }
  const double min_cosine = portable_cos(glm::radians(options.crease));
  std::vector<glm::dvec3> normals;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const glm::dvec3 own = glm::normalize(areas[i]);
    normals.clear();
    for (const std::uint32_t corner : mesh.polygons[i]) {
      glm::dvec3 sum(0.0);
      for (const std::uint32_t other : around[corner]) {
        if (glm::dot(own, glm::normalize(areas[other])) >= min_cosine) sum += areas[other];
      }
      normals.push_back(glm::normalize(sum));
    }
    if (options.paint) builder.set_surface(options.paint(i));
    builder.add_polygon(renumbered(mesh.polygons[i], index), normals);
  }
}

}  // namespace beambench::scenes::modelling

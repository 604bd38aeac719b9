#include "scenes/modelling/polygon_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec4.hpp>

#include "scenes/base/portable_math.hpp"

namespace beambench::scenes::modelling {
namespace {

/// Finds the first vertex within a distance. Vertices are sorted into cells of that size.
class NearVertices {
 public:
  explicit NearVertices(double distance) : distance_(distance) {}

  std::optional<std::uint32_t> find(const std::vector<glm::dvec3>& vertices,
                                    const glm::dvec3& place) const {
    const Cell cell = cell_of(place);
    std::optional<std::uint32_t> found;
    for (std::int64_t neighbor = 0; neighbor < 27; ++neighbor) {
      const Cell near = {cell[0] + neighbor % 3 - 1, cell[1] + neighbor / 3 % 3 - 1,
                         cell[2] + neighbor / 9 - 1};
      const auto [begin, end] = cells_.equal_range(near);
      for (auto it = begin; it != end; ++it) {
        const bool same = glm::length(vertices[it->second] - place) <= distance_;
        if (same && (!found || it->second < *found)) found = it->second;
      }
    }
    return found;
  }
  void add(const glm::dvec3& place, std::uint32_t vertex) {
    cells_.emplace(cell_of(place), vertex);
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  Cell cell_of(const glm::dvec3& place) const {
    const glm::dvec3 cell = glm::floor(place / distance_);
    return {static_cast<std::int64_t>(cell.x), static_cast<std::int64_t>(cell.y),
            static_cast<std::int64_t>(cell.z)};
  }

  double distance_;
  std::multimap<Cell, std::uint32_t> cells_;
};

}  // namespace

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

PolygonMesh welded(const PolygonMesh& mesh) {
  double largest = 0.0;
  for (const glm::dvec3& vertex : mesh.vertices) {
    largest = std::max({largest, std::abs(vertex.x), std::abs(vertex.y), std::abs(vertex.z)});
  }
  if (largest == 0.0) return {};

  PolygonMesh result;
  NearVertices near(1e-9 * largest);
  std::vector<std::uint32_t> index;  // the mesh's vertices as indices in the result
  for (const glm::dvec3& vertex : mesh.vertices) {
    const auto found = near.find(result.vertices, vertex);
    index.push_back(found ? *found : static_cast<std::uint32_t>(result.vertices.size()));
    if (found) continue;
    near.add(vertex, index.back());
    result.vertices.push_back(vertex);
  }
  for (const PolygonMesh::Corners& corners : mesh.polygons) {
    PolygonMesh::Corners kept;
    for (const std::uint32_t corner : corners) {
      if (kept.empty() || kept.back() != index[corner]) kept.push_back(index[corner]);
    }
    while (kept.size() > 1 && kept.back() == kept.front()) kept.pop_back();
    if (kept.size() >= 3) result.polygons.push_back(kept);
  }
  return result;
}

}  // namespace beambench::scenes::modelling

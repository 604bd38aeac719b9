#include "scenes/modelling/extrusion.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

namespace beambench::scenes::modelling {

FlatShape flat_polygon(std::vector<glm::dvec2> points) {
  PolygonMesh::Corners corners(points.size());
  std::iota(corners.begin(), corners.end(), 0U);
  return {std::move(points), {std::move(corners)}};
}

PolygonMesh extruded(const FlatShape& shape, double depth, Ends ends) {
  PolygonMesh mesh;
  for (const glm::dvec2& point : shape.points) mesh.vertices.emplace_back(point, 0.0);
  for (const glm::dvec2& point : shape.points) mesh.vertices.emplace_back(point, depth);
  const auto front = static_cast<std::uint32_t>(shape.points.size());

  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const PolygonMesh::Corners& corners : shape.polygons) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      edges.emplace(corners[i], corners[(i + 1) % corners.size()]);
    }
    if (ends != Ends::kNone) {
      PolygonMesh::Corners& face = mesh.polygons.emplace_back(corners);
      for (std::uint32_t& corner : face) corner += front;
    }
    if (ends == Ends::kBoth) mesh.polygons.emplace_back(corners.rbegin(), corners.rend());
  }
  for (const auto& [a, b] : edges) {
    if (edges.contains({b, a})) continue;  // an inner seam
    mesh.polygons.push_back({a, b, b + front, a + front});
  }
  return mesh;
}

}  // namespace beambench::scenes::modelling

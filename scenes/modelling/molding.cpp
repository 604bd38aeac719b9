#include "scenes/modelling/molding.hpp"

namespace beambench::scenes::modelling {

PolygonMesh molding(const glm::dvec2& size, std::span<const glm::dvec2> profile) {
  PolygonMesh mesh;
  for (const glm::dvec2& point : profile) {
    const double inset = point.x;
    mesh.vertices.insert(mesh.vertices.end(), {{inset, inset, point.y},
                                               {size.x - inset, inset, point.y},
                                               {size.x - inset, size.y - inset, point.y},
                                               {inset, size.y - inset, point.y}});
  }
  const auto last = static_cast<std::uint32_t>(4 * (profile.size() - 1));
  for (std::uint32_t first = 0; first < last; first += 4) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t next = first + (i + 1) % 4;
      mesh.polygons.push_back({first + i, next, next + 4, first + i + 4});
    }
  }
  return mesh;
}

PolygonMesh without_side(const PolygonMesh& molding, std::size_t side) {
  PolygonMesh mesh;
  mesh.vertices = molding.vertices;
  for (std::size_t i = 0; i < molding.size(); ++i) {
    if (i % 4 != side) mesh.polygons.push_back(molding.polygons[i]);
  }
  return mesh;
}

}  // namespace beambench::scenes::modelling

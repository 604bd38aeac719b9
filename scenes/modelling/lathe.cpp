#include "scenes/modelling/lathe.hpp"

#include <numbers>

#include "scenes/core/portable_math.hpp"

namespace beambench::scenes::modelling {

PolygonMesh lathe(std::span<const glm::dvec2> profile, int sides, double first_turn) {
  PolygonMesh mesh;
  std::vector<std::uint32_t> first;  // of each profile point's ring, or its one vertex on the axis
  for (const glm::dvec2& point : profile) {
    first.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    const int copies = point.x == 0.0 ? 1 : sides;
    for (int i = 0; i < copies; ++i) {
      const double angle = 2.0 * std::numbers::pi * (first_turn + static_cast<double>(i) / sides);
      mesh.vertices.emplace_back(point.x * portable_cos(angle), point.x * portable_sin(angle),
                                 point.y);
    }
  }
  const auto steps = static_cast<std::uint32_t>(sides);
  for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
    const bool bottom_pole = profile[k].x == 0.0;
    const bool top_pole = profile[k + 1].x == 0.0;
    if (bottom_pole && top_pole) continue;
    for (std::uint32_t i = 0; i < steps; ++i) {
      const std::uint32_t next = (i + 1) % steps;
      PolygonMesh::Corners corners;
      corners.push_back(first[k] + (bottom_pole ? 0 : i));
      if (!bottom_pole) corners.push_back(first[k] + next);
      corners.push_back(first[k + 1] + (top_pole ? 0 : next));
      if (!top_pole) corners.push_back(first[k + 1] + i);
      mesh.polygons.push_back(corners);
    }
  }
  return mesh;
}

}  // namespace beambench::scenes::modelling

#include "scenes/generators/thesis/room/window_view.hpp"

#include <array>
#include <cstddef>
#include <vector>

#include "scenes/core/portable_math.hpp"
#include "scenes/generators/thesis/room/placed_piece.hpp"
#include "scenes/modelling/extrusion.hpp"

namespace beambench::scenes::generators {
namespace {

using Line = std::vector<glm::dvec2>;

/// A line of hills from the left edge to the right one.
Line hills(const glm::dvec2& size, double height, double swing, double phase) {
  constexpr int kPieces = 24;
  Line line;
  for (int i = 0; i <= kPieces; ++i) {
    const double x = static_cast<double>(i) / kPieces;
    const double rise = portable_sin(5.3 * x + phase) + 0.4 * portable_sin(12.1 * x + 2.0 * phase);
    line.emplace_back(size.x * x, size.y * (height + swing * rise));
  }
  return line;
}

Line level(const glm::dvec2& size, double height) {
  return {{0.0, size.y * height}, {size.x, size.y * height}};
}

/// What lies between two lines.
modelling::PolygonMesh between(const Line& low, const Line& high) {
  Line outline = low;
  outline.insert(outline.end(), high.rbegin(), high.rend());
  modelling::PolygonMesh mesh;
  const modelling::FlatShape shape = modelling::flat_polygon(outline);
  for (const glm::dvec2& point : shape.points) mesh.vertices.emplace_back(point, 0.0);
  mesh.polygons = shape.polygons;
  return mesh;
}

}  // namespace

void add_window_view(SceneBuilder& builder, const glm::dmat4& place, const glm::dvec2& size) {
  const std::array<Line, 6> lines = {level(size, 0.0),
                                     hills(size, 0.24, 0.05, 0.6),
                                     hills(size, 0.42, 0.06, 2.4),
                                     level(size, 0.62),
                                     level(size, 0.80),
                                     level(size, 1.0)};
  constexpr std::array<glm::vec3, 5> kColors = {{{0.52F, 0.74F, 0.36F},
                                                 {0.45F, 0.63F, 0.52F},
                                                 {0.87F, 0.95F, 1.0F},
                                                 {0.76F, 0.90F, 1.0F},
                                                 {0.64F, 0.84F, 1.0F}}};
  PlacedPiece view(builder, place);
  for (std::size_t i = 0; i < kColors.size(); ++i) {
    view.flat({.color = kColors[i], .diffuse = 1.0F}, between(lines[i], lines[i + 1]));
  }
}

}  // namespace beambench::scenes::generators

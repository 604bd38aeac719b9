#include "scenes/generators/thesis/tiled_roof.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "scenes/core/portable_math.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr int kPieces = 6;  // around a tile and the channel beside it

/// A strip of quads between two lines of as many points.
void add_strip(modelling::PolygonMesh& mesh, const std::vector<glm::dvec3>& low,
               const std::vector<glm::dvec3>& high) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto count = static_cast<std::uint32_t>(low.size());
  mesh.vertices.insert(mesh.vertices.end(), low.begin(), low.end());
  mesh.vertices.insert(mesh.vertices.end(), high.begin(), high.end());
  for (std::uint32_t i = 0; i + 1 < count; ++i) {
    mesh.polygons.push_back({first + i, first + i + 1, first + count + i + 1, first + count + i});
  }
}

}  // namespace

modelling::PolygonMesh tiled_slope(const RoofSlope& slope) {
  const glm::dvec3 outward = glm::normalize(glm::cross(slope.along, slope.up));
  const double width = glm::length(slope.along) / slope.tiles;
  const double overlap = 0.35 / slope.rows;
  modelling::PolygonMesh mesh;
  for (int row = 0; row < slope.rows; ++row) {
    const double start = static_cast<double>(row) / slope.rows;
    const double end =
        static_cast<double>(row + 1) / slope.rows + (row + 1 < slope.rows ? overlap : 0.0);
    std::vector<glm::dvec3> low;
    std::vector<glm::dvec3> high;
    for (int i = 0; i <= kPieces * slope.tiles; ++i) {
      const double share = static_cast<double>(i) / (kPieces * slope.tiles);
      const double wave = -portable_cos(2.0 * std::numbers::pi * i / kPieces);
      const glm::dvec3 place = slope.corner + share * slope.along + 0.22 * width * wave * outward;
      low.push_back(place + start * slope.up + 0.06 * width * outward);
      high.push_back(place + end * slope.up);
    }
    add_strip(mesh, low, high);
  }
  return mesh;
}

modelling::PolygonMesh ridge_tiles(const glm::dvec3& from, const glm::dvec3& to, double radius,
                                   int tiles) {
  const glm::dvec3 way = to - from;
  const glm::dvec3 up(0.0, 0.0, 1.0);
  const glm::dvec3 aside = glm::normalize(glm::cross(way, up));
  const auto arc = [&](double share, double size) {
    std::vector<glm::dvec3> places;
    for (int i = 0; i <= kPieces; ++i) {
      const double angle = std::numbers::pi * i / kPieces;
      places.push_back(from + share * way +
                       size * (portable_cos(angle) * aside + portable_sin(angle) * up));
    }
    return places;
  };
  modelling::PolygonMesh mesh;
  for (int i = 0; i < tiles; ++i) {
    const double start = static_cast<double>(i) / tiles;
    const double end = std::min(1.0, (i + 1.1) / tiles);
    add_strip(mesh, arc(end, 0.92 * radius), arc(start, radius));
  }
  return mesh;
}

}  // namespace beambench::scenes::generators

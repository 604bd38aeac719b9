#include "scenes/modelling/walls.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>

namespace beambench::scenes::modelling {
namespace {

/// Adds a quad between two corners of a plane, at the height z.
void add_flat_quad(PolygonMesh& mesh, const Rectangle& place, double z) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{place.lower.x, place.lower.y, z},
                                             {place.upper.x, place.lower.y, z},
                                             {place.upper.x, place.upper.y, z},
                                             {place.lower.x, place.upper.y, z}});
  mesh.polygons.push_back({first, first + 1, first + 2, first + 3});
}

/// Returns the front, cut along the edges of all openings.
PolygonMesh front(const glm::dvec2& size, std::span<const Rectangle> openings) {
  std::set<double> across = {0.0, size.x};
  std::set<double> up = {0.0, size.y};
  for (const Rectangle& opening : openings) {
    across.insert({opening.lower.x, opening.upper.x});
    up.insert({opening.lower.y, opening.upper.y});
  }
  PolygonMesh mesh;
  for (auto y = up.begin(); std::next(y) != up.end(); ++y) {
    for (auto x = across.begin(); std::next(x) != across.end(); ++x) {
      const Rectangle cell = {{*x, *y}, {*std::next(x), *std::next(y)}};
      const bool is_open = std::any_of(openings.begin(), openings.end(), [&](const Rectangle& o) {
        return o.lower.x <= cell.lower.x && cell.upper.x <= o.upper.x &&
               o.lower.y <= cell.lower.y && cell.upper.y <= o.upper.y;
      });
      if (!is_open) add_flat_quad(mesh, cell, 0.0);
    }
  }
  return mesh;
}

}  // namespace

PolygonMesh recessed(const glm::dvec2& size, std::span<const Rectangle> openings, double depth) {
  PolygonMesh mesh = front(size, openings);
  for (const Rectangle& opening : openings) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const double z : {0.0, -depth}) {
      mesh.vertices.insert(mesh.vertices.end(), {{opening.lower.x, opening.lower.y, z},
                                                 {opening.upper.x, opening.lower.y, z},
                                                 {opening.upper.x, opening.upper.y, z},
                                                 {opening.lower.x, opening.upper.y, z}});
    }
    const std::array<bool, 4> at_edge = {opening.lower.y <= 0.0, opening.upper.x >= size.x,
                                         opening.upper.y >= size.y, opening.lower.x <= 0.0};
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t next = (i + 1) % 4;
      if (at_edge[i]) continue;
      mesh.polygons.push_back({first + i, first + i + 4, first + next + 4, first + next});
      std::reverse(mesh.polygons.back().begin(), mesh.polygons.back().end());
    }
  }
  return mesh;
}

PolygonMesh openings_filled(std::span<const Rectangle> openings, double depth) {
  PolygonMesh mesh;
  for (const Rectangle& opening : openings) add_flat_quad(mesh, opening, -depth);
  return mesh;
}

std::vector<Rectangle> panes(const glm::dvec2& size, int columns, int rows, double bar) {
  const glm::dvec2 count(columns, rows);
  const glm::dvec2 pane = (size - bar * (count + 1.0)) / count;
  std::vector<Rectangle> result;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const glm::dvec2 lower = bar + glm::dvec2(column, row) * (pane + bar);
      result.push_back({lower, lower + pane});
    }
  }
  return result;
}

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

#include "scenes/modelling/implicit_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace beambench::scenes::modelling {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

glm::dvec3 gradient(const Field& field, const glm::dvec3& place, double step) {
  glm::dvec3 result;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 offset(0.0);
    offset[axis] = step;
    result[axis] = (field(place + offset) - field(place - offset)) / (2.0 * step);
  }
  return result;
}

/// Moves a point onto the surface by Newton steps along the gradient, none longer than half of
/// `reach`.
glm::dvec3 onto_surface(const Field& field, glm::dvec3 place, double reach) {
  for (int i = 0; i < 4; ++i) {
    const glm::dvec3 slope = gradient(field, place, 1e-4 * reach);
    const double steepness = glm::dot(slope, slope);
    if (steepness < 1e-12) break;
    const glm::dvec3 step = slope * (field(place) / steepness);
    const double length = glm::length(step);
    place -= length > 0.5 * reach ? step * (0.5 * reach / length) : step;
  }
  return place;
}

/// Builds a surface from a field on a grid, with a vertex in every cell that the surface crosses
/// and a quad at every edge that it crosses.
class SurfaceNet {
 public:
  SurfaceNet(const Field& field, const glm::dvec3& lower, const glm::dvec3& upper, double cell)
      : field_(field), lower_(lower), cell_(cell) {
    for (int axis = 0; axis < 3; ++axis) {
      points_[axis] = static_cast<std::uint32_t>(std::ceil((upper[axis] - lower[axis]) / cell)) + 1;
    }
    values_.reserve(std::size_t{points_[0]} * points_[1] * points_[2]);
    for_each_point([&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
      values_.push_back(field_(place(x, y, z)));
    });
    vertex_of_.assign(values_.size(), kNone);
  }

  PolygonMesh make() {
    for_each_point([&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
      if (x + 1 < points_[0] && y + 1 < points_[1] && z + 1 < points_[2]) add_vertex(x, y, z);
    });
    for_each_point([&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
      for (int axis = 0; axis < 3; ++axis) add_quad({x, y, z}, axis);
    });
    return std::move(mesh_);
  }

 private:
  using Point = std::array<std::uint32_t, 3>;

  template <typename Visit>
  void for_each_point(Visit visit) const {
    for (std::uint32_t z = 0; z < points_[2]; ++z) {
      for (std::uint32_t y = 0; y < points_[1]; ++y) {
        for (std::uint32_t x = 0; x < points_[0]; ++x) visit(x, y, z);
      }
    }
  }

  std::size_t index(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    return (std::size_t{z} * points_[1] + y) * points_[0] + x;
  }
  glm::dvec3 place(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    return lower_ + cell_ * glm::dvec3(x, y, z);
  }

  /// Adds the mean of the points where the surface crosses the cell's twelve edges, moved onto the
  /// surface.
  void add_vertex(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    glm::dvec3 sum(0.0);
    int crossings = 0;
    for (std::uint32_t a = 0; a < 8; ++a) {
      for (std::uint32_t bit = 1; bit < 8; bit <<= 1U) {
        if ((a & bit) != 0) continue;
        const Point from = {x + (a & 1U), y + (a >> 1U & 1U), z + (a >> 2U)};
        const std::uint32_t b = a | bit;
        const Point to = {x + (b & 1U), y + (b >> 1U & 1U), z + (b >> 2U)};
        const double start = values_[index(from[0], from[1], from[2])];
        const double end = values_[index(to[0], to[1], to[2])];
        if ((start < 0.0) == (end < 0.0)) continue;
        sum += glm::mix(place(from[0], from[1], from[2]), place(to[0], to[1], to[2]),
                        start / (start - end));
        ++crossings;
      }
    }
    if (crossings == 0) return;
    vertex_of_[index(x, y, z)] = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.vertices.push_back(onto_surface(field_, sum / static_cast<double>(crossings), cell_));
  }

  /// Adds the quad of the four cells around the edge from a point along an axis.
  void add_quad(const Point& from, int axis) {
    const auto a = static_cast<std::size_t>(axis);
    const std::size_t b = (a + 1) % 3;
    const std::size_t c = (a + 2) % 3;
    Point to = from;
    ++to[a];
    if (to[a] >= points_[a] || from[b] == 0 || from[c] == 0) return;
    const bool starts_inside = values_[index(from[0], from[1], from[2])] < 0.0;
    if (starts_inside == (values_[index(to[0], to[1], to[2])] < 0.0)) return;
    PolygonMesh::Corners corners;
    for (const auto& [down_b, down_c] : {std::pair(1U, 1U), {0U, 1U}, {0U, 0U}, {1U, 0U}}) {
      Point cell = from;
      cell[b] -= down_b;
      cell[c] -= down_c;
      corners.push_back(vertex_of_[index(cell[0], cell[1], cell[2])]);
      if (corners.back() == kNone) return;  // at the edge of the box
    }
    if (!starts_inside) std::reverse(corners.begin(), corners.end());
    mesh_.polygons.push_back(std::move(corners));
  }

  const Field& field_;
  glm::dvec3 lower_;
  double cell_;
  Point points_{};
  std::vector<double> values_;
  std::vector<std::uint32_t> vertex_of_;  ///< vertex of the cell above each grid point
  PolygonMesh mesh_;
};

/// Moves vertices one by one onto borders, undoing moves that would flip a triangle.
class BorderDrawing {
 public:
  BorderDrawing(PolygonMesh mesh, const Field& surface, const Region& region)
      : mesh_(std::move(mesh)), surface_(surface), region_(region) {
    around_.resize(mesh_.vertices.size());
    for (std::uint32_t i = 0; i < mesh_.size(); ++i) {
      for (const std::uint32_t corner : mesh_.polygons[i]) around_[corner].push_back(i);
    }
    for (const glm::dvec3& vertex : mesh_.vertices) region_of_.push_back(region_(vertex));
  }

  PolygonMesh finish() {
    for (std::uint32_t vertex = 0; vertex < mesh_.vertices.size(); ++vertex) draw(vertex);
    return std::move(mesh_);
  }

 private:
  static constexpr int kBorder = -1;

  /// Moves the vertex to the nearest border on its edges, if the border is on its half of the edge.
  void draw(std::uint32_t vertex) {
    const glm::dvec3 start = mesh_.vertices[vertex];
    glm::dvec3 nearest = start;
    double best = 0.55;  // share of an edge's length
    double edge_length = 0.0;
    for (const std::uint32_t triangle : around_[vertex]) {
      for (const std::uint32_t other : mesh_.polygons[triangle]) {
        if (region_of_[other] == kBorder || region_of_[other] == region_of_[vertex]) continue;
        const double share = border(vertex, other);
        if (share >= best) continue;
        best = share;
        nearest = glm::mix(start, mesh_.vertices[other], share);
        edge_length = glm::length(mesh_.vertices[other] - start);
      }
    }
    if (edge_length == 0.0) return;
    if (move(vertex, onto_surface(surface_, nearest, edge_length))) region_of_[vertex] = kBorder;
  }

  /// Returns the parameter, from 0 to 1, at which the first vertex's region ends on the way to the
  /// second.
  double border(std::uint32_t from, std::uint32_t to) const {
    double inside = 0.0;
    double outside = 1.0;
    for (int i = 0; i < 12; ++i) {
      const double half = 0.5 * (inside + outside);
      const glm::dvec3 place = glm::mix(mesh_.vertices[from], mesh_.vertices[to], half);
      (region_(place) == region_of_[from] ? inside : outside) = half;
    }
    return inside;
  }

  bool move(std::uint32_t vertex, const glm::dvec3& to) {
    const glm::dvec3 start = mesh_.vertices[vertex];
    std::vector<glm::dvec3> before;
    for (const std::uint32_t triangle : around_[vertex]) {
      before.push_back(area_normal(mesh_, mesh_.polygons[triangle]));
    }
    mesh_.vertices[vertex] = to;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const glm::dvec3 after = area_normal(mesh_, mesh_.polygons[around_[vertex][i]]);
      if (glm::dot(after, before[i]) < 0.15 * glm::dot(before[i], before[i])) {
        mesh_.vertices[vertex] = start;
        return false;
      }
    }
    return true;
  }

  PolygonMesh mesh_;
  const Field& surface_;
  const Region& region_;
  std::vector<std::vector<std::uint32_t>> around_;
  std::vector<int> region_of_;
};

}  // namespace

double ellipsoid_field(const glm::dvec3& place, const glm::dvec3& center,
                       const glm::dvec3& half_axes) {
  const glm::dvec3 unit = (place - center) / half_axes;
  const double size = glm::length(unit);
  const double slope = glm::length(unit / half_axes);
  if (slope == 0.0) return -std::min({half_axes.x, half_axes.y, half_axes.z});
  return size * (size - 1.0) / slope;
}

double limb_field(const glm::dvec3& place, const Limb& limb) {
  const glm::dvec3 axis = limb.to - limb.from;
  const double share =
      std::clamp(glm::dot(place - limb.from, axis) / glm::dot(axis, axis), 0.0, 1.0);
  return glm::length(place - limb.from - share * axis) -
         std::lerp(limb.from_radius, limb.to_radius, share);
}

double joined(double a, double b, double blend) {
  const double near = std::max(0.0, blend - std::abs(a - b));
  return std::min(a, b) - 0.25 * near * near / blend;
}

PolygonMesh implicit_surface(const Field& field, const glm::dvec3& lower, const glm::dvec3& upper,
                             double cell) {
  return SurfaceNet(field, lower, upper, cell).make();
}

PolygonMesh drawn_to_borders(PolygonMesh mesh, const Field& surface, const Region& region) {
  return BorderDrawing(std::move(mesh), surface, region).finish();
}

PolygonMesh outside(const PolygonMesh& mesh, const Field& body) {
  PolygonMesh result;
  result.vertices = mesh.vertices;
  for (const PolygonMesh::Corners& corners : mesh.polygons) {
    const bool hidden = std::all_of(corners.begin(), corners.end(), [&](std::uint32_t corner) {
      return body(mesh.vertices[corner]) < 0.0;
    });
    if (!hidden) result.polygons.push_back(corners);
  }
  return result;
}

glm::dvec3 middle(const PolygonMesh& mesh, std::size_t polygon) {
  const PolygonMesh::Corners& corners = mesh.polygons[polygon];
  glm::dvec3 sum(0.0);
  for (const std::uint32_t corner : corners) sum += mesh.vertices[corner];
  return sum / static_cast<double>(corners.size());
}

}  // namespace beambench::scenes::modelling

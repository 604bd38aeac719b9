#include "scenes/modelling/subdivide.hpp"

#include <algorithm>
#include <map>
#include <queue>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "scenes/triangulate.hpp"

namespace beambench::scenes::modelling {
namespace {

using Corners = PolygonMesh::Corners;

double area(const PolygonMesh& mesh, const Corners& corners) {
  return 0.5 * glm::length(area_normal(mesh, corners));
}

bool is_convex(const PolygonMesh& mesh, const Corners& corners) {
  const glm::dvec3 normal = area_normal(mesh, corners);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3& a = mesh.vertices[corners[i]];
    const glm::dvec3& b = mesh.vertices[corners[(i + 1) % corners.size()]];
    const glm::dvec3& c = mesh.vertices[corners[(i + 2) % corners.size()]];
    const double turn = glm::dot(glm::cross(b - a, c - b), normal);
    if (turn < -1e-9 * glm::dot(normal, normal)) return false;
  }
  return true;
}

/// Returns the corners from position `from` to position `to`, inclusive, in cyclic order.
Corners part(const Corners& corners, std::size_t from, std::size_t to) {
  Corners result = {corners[from]};
  for (std::size_t i = from; i != to;) {
    i = (i + 1) % corners.size();
    result.push_back(corners[i]);
  }
  return result;
}

class Subdivider {
 public:
  Subdivider(PolygonMesh mesh, std::size_t count) : mesh_(std::move(mesh)), count_(count) {
    for (std::uint32_t i = 0; i < mesh_.size(); ++i) note(i);
  }

  PolygonMesh finish() {
    while (mesh_.size() < count_) split(next());
    return std::move(mesh_);
  }

 private:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;

  static Edge edge(std::uint32_t a, std::uint32_t b) { return std::minmax(a, b); }

  /// Enters a new or changed polygon into the queue and the edge table.
  void note(std::uint32_t polygon) {
    const Corners& corners = mesh_.polygons[polygon];
    for (std::size_t i = 0; i < corners.size(); ++i) {
      auto& sharing = sharing_[edge(corners[i], corners[(i + 1) % corners.size()])];
      if (std::find(sharing.begin(), sharing.end(), polygon) == sharing.end()) {
        sharing.push_back(polygon);
      }
    }
    areas_.resize(mesh_.size(), 0.0);
    areas_[polygon] = is_convex(mesh_, corners) ? area(mesh_, corners) : 0.0;
    if (areas_[polygon] > 0.0) largest_.emplace(areas_[polygon], ~polygon);
  }

  /// Removes a polygon from the edge table before the polygon changes.
  void forget(std::uint32_t polygon) {
    const Corners& corners = mesh_.polygons[polygon];
    for (std::size_t i = 0; i < corners.size(); ++i) {
      std::erase(sharing_[edge(corners[i], corners[(i + 1) % corners.size()])], polygon);
    }
  }

  /// Returns the largest convex polygon, or the first of several equally large ones.
  std::uint32_t next() {
    while (!largest_.empty()) {
      const auto [size, complement] = largest_.top();
      largest_.pop();
      if (areas_[~complement] == size) return ~complement;
    }
    throw std::invalid_argument(
        fmt::format("no polygon is left to split: there are {} of {}", mesh_.size(), count_));
  }

  void split(std::uint32_t polygon) {
    if (mesh_.polygons[polygon].size() > 3) {
      split_along_diagonal(polygon);
    } else {
      split_triangle(polygon);
    }
  }

  void replace(std::uint32_t polygon, Corners corners) {
    forget(polygon);
    mesh_.polygons[polygon] = std::move(corners);
    note(polygon);
  }

  void cut(std::uint32_t polygon, std::size_t from, std::size_t to) {
    const Corners corners = mesh_.polygons[polygon];
    replace(polygon, part(corners, from, to));
    mesh_.polygons.push_back(part(corners, to, from));
    note(static_cast<std::uint32_t>(mesh_.size() - 1));
  }

  /// Returns how even a cut is: the area of the smaller part.
  double evenness(const Corners& corners, std::size_t from, std::size_t to) const {
    return std::min(area(mesh_, part(corners, from, to)), area(mesh_, part(corners, to, from)));
  }

  void split_along_diagonal(std::uint32_t polygon) {
    const Corners& corners = mesh_.polygons[polygon];
    std::pair<std::size_t, std::size_t> best(0, 2);
    for (std::size_t from = 0; from + 2 < corners.size(); ++from) {
      for (std::size_t to = from + 2; to < corners.size() - (from == 0 ? 1 : 0); ++to) {
        if (evenness(corners, from, to) > 1.0001 * evenness(corners, best.first, best.second)) {
          best = {from, to};
        }
      }
    }
    cut(polygon, best.first, best.second);
  }

  void split_triangle(std::uint32_t triangle) {
    const Corners& corners = mesh_.polygons[triangle];
    Edge longest;
    double length = -1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge candidate = edge(corners[i], corners[(i + 1) % 3]);
      const double size =
          glm::length(mesh_.vertices[candidate.first] - mesh_.vertices[candidate.second]);
      if (size > length) {
        length = size;
        longest = candidate;
      }
    }
    const std::vector<std::uint32_t> sharing = sharing_[longest];
    const auto middle = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.vertices.push_back(0.5 *
                             (mesh_.vertices[longest.first] + mesh_.vertices[longest.second]));
    insert_corner(triangle, longest, middle, true);
    for (const std::uint32_t neighbor : sharing) {
      if (neighbor == triangle) continue;
      const bool may_split = mesh_.size() < count_ && areas_[neighbor] > 0.0;
      insert_corner(neighbor, longest, middle, may_split);
    }
  }

  /// Inserts a vertex on a polygon's edge. If `and_cut`, then cuts the polygon from this vertex to
  /// the corner that divides it most evenly.
  void insert_corner(std::uint32_t polygon, const Edge& at, std::uint32_t vertex, bool and_cut) {
    Corners corners = mesh_.polygons[polygon];
    std::size_t i = 0;
    while (edge(corners[i], corners[(i + 1) % corners.size()]) != at) ++i;
    corners.insert(corners.begin() + static_cast<std::ptrdiff_t>(i) + 1, vertex);
    replace(polygon, corners);
    if (!and_cut) return;
    const std::size_t size = corners.size();
    const std::size_t from = i + 1;
    std::size_t best = (from + 2) % size;
    for (std::size_t step = 3; step + 1 < size; ++step) {
      const std::size_t to = (from + step) % size;
      if (evenness(corners, from, to) > evenness(corners, from, best)) best = to;
    }
    cut(polygon, from, best);
  }

  PolygonMesh mesh_;
  std::size_t count_;
  std::map<Edge, std::vector<std::uint32_t>> sharing_;
  std::vector<double> areas_;  ///< areas of convex polygons; 0 for polygons that stay whole
  std::priority_queue<std::pair<double, std::uint32_t>> largest_;  ///< area, ~polygon
};

void triangulate_polygon(const PolygonMesh& mesh, const Corners& corners, PolygonMesh& result) {
  if (corners.size() == 4 && is_convex(mesh, corners)) {
    const auto& v = mesh.vertices;
    const bool even = glm::length(v[corners[0]] - v[corners[2]]) <=
                      glm::length(v[corners[1]] - v[corners[3]]) * (1.0 + 1e-9);
    const std::size_t from = even ? 0 : 1;
    result.polygons.push_back(part(corners, from, from + 2));
    result.polygons.push_back(part(corners, from + 2, from));
    return;
  }
  std::vector<glm::vec3> places;
  for (const std::uint32_t corner : corners) places.emplace_back(mesh.vertices[corner]);
  for (const auto& [a, b, c] : triangulate(places)) {
    result.polygons.push_back({corners[a], corners[b], corners[c]});
  }
}

}  // namespace

PolygonMesh triangulated(const PolygonMesh& mesh) {
  PolygonMesh result;
  result.vertices = mesh.vertices;
  for (const Corners& corners : mesh.polygons) {
    if (corners.size() == 3) {
      result.polygons.push_back(corners);
    } else {
      triangulate_polygon(mesh, corners, result);
    }
  }
  return result;
}

PolygonMesh subdivided_to(PolygonMesh mesh, std::size_t count) {
  // A negative difference arrives as a huge number.
  constexpr std::size_t kMaxPolygons = 100'000'000;
  if (count > kMaxPolygons) {
    throw std::invalid_argument(
        fmt::format("{} polygons are requested, more than {}: did the scene already "
                    "have too many?",
                    count, kMaxPolygons));
  }
  if (mesh.size() > count) {
    throw std::invalid_argument(
        fmt::format("the mesh has {} polygons, more than the {} requested", mesh.size(), count));
  }
  return Subdivider(std::move(mesh), count).finish();
}

}  // namespace beambench::scenes::modelling

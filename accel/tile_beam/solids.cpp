#include "accel/tile_beam/solids.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numeric>

#include <glm/geometric.hpp>

#include "accel/core/large_pages.hpp"

namespace beambench::accel::tile_beam {
namespace {

using Numbers = LargePageVector<std::uint32_t>;

/// Returns the first vertex at each vertex's position, using a hash table with open addressing.
Numbers first_at_place(const std::vector<glm::vec3>& vertices) {
  constexpr std::uint32_t kFree = ~0U;
  Numbers table(std::bit_ceil(2 * vertices.size() + 1), kFree);
  const std::size_t mask = table.size() - 1;
  Numbers first(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    const glm::vec3 place = vertices[i] + 0.0F;  // -0 is at the place of 0
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
      hash = (hash ^ std::bit_cast<std::uint32_t>(place[axis])) * 0x9E3779B97F4A7C15ULL;
      hash ^= hash >> 32U;
    }
    std::size_t slot = hash & mask;
    while (table[slot] != kFree && vertices[table[slot]] != place) slot = (slot + 1) & mask;
    if (table[slot] == kFree) table[slot] = i;
    first[i] = table[slot];
  }
  return first;
}

/// Disjoint sets of triangles (union by the lower number, with path halving).
class Components {
 public:
  explicit Components(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  std::uint32_t of(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    if (parent_[a] == parent_[b]) return;
    const std::uint32_t low = of(std::min(a, b));
    const std::uint32_t high = of(std::max(a, b));
    parent_[std::max(low, high)] = std::min(low, high);
  }

 private:
  Numbers parent_;
};

/// Triangles joined in pairs along their edges.
class JoinedTriangles {
 public:
  JoinedTriangles(const scenes::Scene& scene, const Numbers& place)
      : components_(scene.triangles.size()),
        is_open_(scene.triangles.size(), 0),
        first_(scene.vertices.size() + 1) {
    for_each_edge(scene, place, [&](std::uint32_t triangle, std::uint32_t from, std::uint32_t to) {
      if (from < to) ++first_[from + 1];
      if (from == to) is_open_[triangle] = 1;
    });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    upward_.resize(first_.back());
    Numbers next(first_.begin(), first_.end() - 1);
    for_each_edge(scene, place, [&](std::uint32_t triangle, std::uint32_t from, std::uint32_t to) {
      if (from < to) upward_[next[from]++] = {to, triangle};
    });
    for_each_edge(scene, place, [&](std::uint32_t triangle, std::uint32_t from, std::uint32_t to) {
      if (from > to) join(triangle, from, to);
    });
    for (const Upward& edge : upward_) {
      if (edge.to != kJoined) is_open_[edge.triangle] = 1;
    }
  }

  /// Returns the lowest-numbered triangle joined with a triangle, including itself.
  std::uint32_t component(std::uint32_t triangle) { return components_.of(triangle); }
  /// Returns whether a triangle has an edge without a partner in the opposite direction.
  bool is_open(std::uint32_t triangle) const { return is_open_[triangle] != 0; }

 private:
  static constexpr std::uint32_t kJoined = ~0U;

  /// An edge to a higher-numbered vertex, listed at the lower one.
  struct Upward {
    std::uint32_t to;  ///< kJoined if it has a partner
    std::uint32_t triangle;
  };

  template <class Visit>
  static void for_each_edge(const scenes::Scene& scene, const Numbers& place, Visit visit) {
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
      const auto& vertex = scene.triangles[t].vertex;
      const std::array<std::uint32_t, 3> at{place[vertex[0]], place[vertex[1]], place[vertex[2]]};
      visit(t, at[0], at[1]);
      visit(t, at[1], at[2]);
      visit(t, at[2], at[0]);
    }
  }

  /// Finds and joins the partner of a downward edge.
  void join(std::uint32_t triangle, std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t i = first_[to]; i < first_[to + 1]; ++i) {
      if (upward_[i].to != from) continue;
      components_.join(triangle, upward_[i].triangle);
      upward_[i].to = kJoined;
      return;
    }
    is_open_[triangle] = 1;
  }

  Components components_;
  std::vector<std::uint8_t> is_open_;
  Numbers first_;  ///< of each vertex, in `upward_`
  LargePageVector<Upward> upward_;
};

/// Triangles connected by shared edges, and whether they may form a solid.
struct Surface {
  scenes::Bounds box;
  std::uint32_t triangles = 0;
  std::uint32_t crossings = 0;  ///< triangles that the ray from the center meets
  int sign = 0;                 ///< of the volumes about the center
  bool is_candidate = true;
  std::uint32_t solid = Solids::kNone;
};

/// Returns the corners of a triangle as seen from a point.
std::array<glm::dvec3, 3> corners_from(const scenes::Scene& scene, std::uint32_t triangle,
                                       const glm::dvec3& point) {
  std::array<glm::dvec3, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = glm::dvec3(scene.vertices[scene.triangles[triangle].vertex[i]]) - point;
  }
  return corners;
}

/// Returns the position of a ray from a point relative to a triangle: the volumes spanned by its
/// direction and each edge, as seen from the point. If all are positive, the ray meets the
/// triangle, whose volume about the point is positive, at t = `volume` / their sum.
glm::dvec3 volumes_beside(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& direction) {
  return {glm::dot(direction, glm::cross(corners[1], corners[2])),
          glm::dot(direction, glm::cross(corners[2], corners[0])),
          glm::dot(direction, glm::cross(corners[0], corners[1]))};
}

double smallest(const glm::dvec3& v) { return std::min({v.x, v.y, v.z}); }

/// Adds a triangle to the data of its surface.
void look_from_center(const scenes::Scene& scene, std::uint32_t triangle, Surface& surface) {
  constexpr double kRounding = 1e-12;            // generous, for sums of products of doubles
  const glm::dvec3 ray(0.5377, 0.7911, 0.2931);  // an arbitrary direction that no model favors
  const auto corners = corners_from(
      scene, triangle, 0.5 * (glm::dvec3(surface.box.lower) + glm::dvec3(surface.box.upper)));
  double lengths = 1.0;  // of the corners, squared and multiplied
  double longest = 0.0;
  for (const glm::dvec3& corner : corners) {
    lengths *= glm::dot(corner, corner);
    longest = std::max(longest, glm::dot(corner, corner));
  }
  const double volume = glm::dot(corners[0], glm::cross(corners[1], corners[2]));
  const int sign = volume > 0.0 ? 1 : -1;
  if (surface.sign == 0) surface.sign = sign;
  const double beside = smallest(volumes_beside(corners, ray) * static_cast<double>(sign));
  const bool is_clear =
      volume * volume > kRounding * kRounding * lengths && std::abs(beside) > kRounding * longest;
  if (!is_clear || sign != surface.sign) {
    surface.is_candidate = false;
  } else if (beside > 0.0) {
    ++surface.crossings;
  }
}

/// Returns the surfaces of a scene; `of` receives the surface of each triangle.
std::vector<Surface> find_surfaces(const scenes::Scene& scene, Numbers& of) {
  const auto count = static_cast<std::uint32_t>(scene.triangles.size());
  JoinedTriangles joined(scene, first_at_place(scene.vertices));
  of.resize(count);
  std::vector<Surface> surfaces;
  for (std::uint32_t t = 0; t < count; ++t) {
    const std::uint32_t first = joined.component(t);
    of[t] = first == t ? static_cast<std::uint32_t>(surfaces.size()) : of[first];
    if (first == t) surfaces.emplace_back();
    Surface& surface = surfaces[of[t]];
    ++surface.triangles;
    if (joined.is_open(t)) surface.is_candidate = false;
    for (const std::uint32_t v : scene.triangles[t].vertex) surface.box.include(scene.vertices[v]);
  }
  for (std::uint32_t t = 0; t < count; ++t) {
    Surface& surface = surfaces[of[t]];
    if (surface.is_candidate) look_from_center(scene, t, surface);
  }
  return surfaces;
}

}  // namespace

Solids find_solids(const scenes::Scene& scene) {
  Solids found;
  std::vector<Surface> surfaces = find_surfaces(scene, found.of_triangle);
  std::uint32_t triangles = 0;
  for (Surface& surface : surfaces) {
    if (!surface.is_candidate || surface.crossings != 1) continue;
    surface.solid = static_cast<std::uint32_t>(found.solids.size());
    const glm::dvec3 center = 0.5 * (glm::dvec3(surface.box.lower) + glm::dvec3(surface.box.upper));
    found.solids.push_back({surface.box, center, surface.sign < 0, triangles, surface.triangles});
    triangles += surface.triangles;
  }
  found.triangles.resize(triangles);
  std::vector<std::uint32_t> next;
  for (const Solid& solid : found.solids) next.push_back(solid.first_triangle);
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    std::uint32_t& solid = found.of_triangle[t];
    solid = surfaces[solid].solid;
    if (solid != Solids::kNone) found.triangles[next[solid]++] = t;
  }
  return found;
}

bool is_outside(const scenes::Scene& scene, const Solids& solids, const Solid& solid,
                const glm::vec3& eye, std::size_t most_triangles) {
  const float largest =
      std::max({std::abs(eye.x), std::abs(eye.y), std::abs(eye.z), solid.box.largest_coordinate()});
  const double margin = 0x1p-18 * static_cast<double>(largest);  // above the error of float tests
  const glm::dvec3 from(eye);
  const auto beyond = [&](int axis) {
    return from[axis] < solid.box.lower[axis] - margin ||
           from[axis] > solid.box.upper[axis] + margin;
  };
  if (beyond(0) || beyond(1) || beyond(2)) return true;
  if (solid.triangle_count > most_triangles) return false;
  const double sign = solid.inward ? -1.0 : 1.0;
  const glm::dvec3 out = from - solid.center;
  bool met = false;
  for (const std::uint32_t triangle : solids.triangles_of(solid)) {
    const auto corners = corners_from(scene, triangle, solid.center);
    const glm::dvec3 beside = sign * volumes_beside(corners, out);
    const double sum = beside.x + beside.y + beside.z;
    if (smallest(beside) < -1e-9 * std::abs(sum)) continue;
    const double volume = sign * glm::dot(corners[0], glm::cross(corners[1], corners[2]));
    const double twice_area =
        glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    if (sum - volume <= margin * twice_area) return false;
    met = true;
  }
  return met;
}

}  // namespace beambench::accel::tile_beam

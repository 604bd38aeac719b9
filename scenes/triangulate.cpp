#include "scenes/triangulate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace beambench::scenes {
namespace {

/// The corners projected along the largest axis of the polygon's normal, mirrored where needed so
/// that the polygon runs counter-clockwise; nothing when it has no area. Differences to the first
/// corner keep their bits far from the origin.
std::optional<std::vector<glm::dvec2>> project(std::span<const glm::vec3> corners) {
  std::vector<glm::dvec3> relative;
  relative.reserve(corners.size());
  for (const glm::vec3& corner : corners) {
    relative.push_back(glm::dvec3(corner) - glm::dvec3(corners.front()));
  }
  glm::dvec3 normal(0.0);  // Newell: the sum of the signed areas seen from the first corner
  for (std::size_t i = 1; i + 1 < relative.size(); ++i) {
    normal += glm::cross(relative[i], relative[i + 1]);
  }
  int axis = 0;
  if (std::abs(normal.y) > std::abs(normal[axis])) axis = 1;
  if (std::abs(normal.z) > std::abs(normal[axis])) axis = 2;
  if (normal[axis] == 0.0) return std::nullopt;

  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const double mirror = normal[axis] > 0.0 ? 1.0 : -1.0;
  std::vector<glm::dvec2> points;
  points.reserve(relative.size());
  for (const glm::dvec3& point : relative) points.emplace_back(mirror * point[u], point[v]);
  return points;
}

/// Twice the signed area of a triangle, positive when it runs counter-clockwise.
double area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// What is left of a polygon while ears are clipped off it: a ring of corner numbers.
class Ring {
 public:
  explicit Ring(std::vector<glm::dvec2> points)
      : points_(std::move(points)), next_(points_.size()), previous_(points_.size()) {
    const auto count = static_cast<std::uint32_t>(points_.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      next_[i] = (i + 1) % count;
      previous_[next_[i]] = i;
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      if (ear_area(i) <= 0.0) not_convex_.push_back(i);
    }
  }

  std::uint32_t next(std::uint32_t i) const { return next_[i]; }
  std::uint32_t previous(std::uint32_t i) const { return previous_[i]; }

  /// Twice the area of the triangle that would go with corner i.
  double ear_area(std::uint32_t i) const {
    return area(points_[previous_[i]], points_[i], points_[next_[i]]);
  }

  /// Whether corner i is strictly convex and no other corner lies in its closed triangle. It is
  /// enough to look at corners that are not convex, and a convex corner stays convex (Eberly 2002);
  /// a corner at the very place of one of the triangle's own (a bridge to a hole) does not count.
  bool is_ear(std::uint32_t i) const {
    if (ear_area(i) <= 0.0) return false;
    const glm::dvec2 a = points_[previous_[i]];
    const glm::dvec2 b = points_[i];
    const glm::dvec2 c = points_[next_[i]];
    return std::none_of(not_convex_.begin(), not_convex_.end(), [&](std::uint32_t j) {
      const glm::dvec2 p = points_[j];
      const bool inside = area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0;
      return inside && p != a && p != b && p != c;
    });
  }

  void remove(std::uint32_t i) {
    next_[previous_[i]] = next_[i];
    previous_[next_[i]] = previous_[i];
    std::erase_if(not_convex_, [&](std::uint32_t j) { return j == i || ear_area(j) > 0.0; });
  }

 private:
  std::vector<glm::dvec2> points_;
  std::vector<std::uint32_t> next_;
  std::vector<std::uint32_t> previous_;
  std::vector<std::uint32_t> not_convex_;
};

/// The first corner from `start` on, once around, that satisfies the condition.
template <typename Condition>
std::optional<std::uint32_t> find_corner(const Ring& ring, std::uint32_t start,
                                         Condition condition) {
  std::uint32_t i = start;
  do {
    if (condition(i)) return i;
    i = ring.next(i);
  } while (i != start);
  return std::nullopt;
}

/// The corner to clip next: an ear; failing that, a corner without area, so that corners on a
/// straight edge are kept as long as another triangle can use them (neighbors that share such a
/// corner then meet without a crack); failing that, the polygon crosses itself and any convex
/// corner will do.
std::optional<std::uint32_t> next_to_clip(const Ring& ring, std::uint32_t start) {
  auto corner = find_corner(ring, start, [&](std::uint32_t i) { return ring.is_ear(i); });
  if (!corner) {
    corner = find_corner(ring, start, [&](std::uint32_t i) { return ring.ear_area(i) == 0.0; });
  }
  if (!corner) {
    corner = find_corner(ring, start, [&](std::uint32_t i) { return ring.ear_area(i) > 0.0; });
  }
  return corner;
}

}  // namespace

bool has_area(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::dvec3 origin(a);
  return glm::cross(glm::dvec3(b) - origin, glm::dvec3(c) - origin) != glm::dvec3(0.0);
}

std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const glm::vec3> corners) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  if (corners.size() < 3) return triangles;
  auto points = project(corners);
  if (!points) return triangles;

  triangles.reserve(corners.size() - 2);
  Ring ring(std::move(*points));
  std::uint32_t start = 1;  // a convex polygon becomes a fan around corner 0
  for (std::size_t left = corners.size(); left >= 3; --left) {
    const auto corner = next_to_clip(ring, start);
    if (!corner) break;
    if (ring.ear_area(*corner) > 0.0) {
      triangles.push_back({ring.previous(*corner), *corner, ring.next(*corner)});
    }
    ring.remove(*corner);
    start = ring.next(*corner);
  }
  return triangles;
}

}  // namespace beambench::scenes

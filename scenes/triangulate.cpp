#include "scenes/triangulate.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "scenes/corner_search.hpp"

namespace beambench::scenes {
namespace {

/// Projects the corners along the largest component of the polygon's normal, mirrored if needed so
/// that the polygon runs counter-clockwise. Returns nothing if the polygon has no area. Differences
/// from the first corner keep their precision far from the origin.
std::optional<std::vector<glm::dvec2>> project(std::span<const glm::vec3> corners) {
  std::vector<glm::dvec3> relative;
  relative.reserve(corners.size());
  for (const glm::vec3& corner : corners) {
    relative.push_back(glm::dvec3(corner) - glm::dvec3(corners.front()));
  }
  glm::dvec3 normal(0.0);  // Newell's: the sum of the signed areas seen from the first corner
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

/// The remaining polygon while ears are clipped off: a ring of corner numbers. The state of each
/// corner is stored; when a corner is removed, only its neighbors' states change.
class Ring {
 public:
  explicit Ring(std::vector<glm::dvec2> points)
      : points_(std::move(points)),
        next_(points_.size()),
        previous_(points_.size()),
        convex_(count()),
        without_area_(count()),
        may_be_ear_(count()),
        not_convex_(points_, link_and_classify()) {
    if (not_convex_.empty()) return;
    in_its_way_.resize(points_.size(), kNone);
    in_the_way_of_.resize(points_.size());
  }

  std::uint32_t next(std::uint32_t i) const { return next_[i]; }
  std::uint32_t previous(std::uint32_t i) const { return previous_[i]; }

  /// Returns twice the area of the triangle that would be removed with corner i.
  double ear_area(std::uint32_t i) const {
    return signed_area(points_[previous_[i]], points_[i], points_[next_[i]]);
  }

  /// Returns the corner to clip next, the first of its kind from `start` on. The first choice is an
  /// ear, the second a corner without area. Corners on a straight edge are thus kept as long as
  /// another triangle can use them, and neighbors that share such a corner meet without a crack. If
  /// there is neither kind, the polygon crosses itself, and any convex corner will do.
  std::optional<std::uint32_t> next_to_clip(std::uint32_t start) {
    while (const auto corner = may_be_ear_.next(start)) {
      if (is_ear(*corner)) return corner;
      may_be_ear_.assign(*corner, false);
    }
    const auto corner = without_area_.next(start);
    return corner ? corner : convex_.next(start);
  }

  void remove(std::uint32_t i) {
    next_[previous_[i]] = next_[i];
    previous_[next_[i]] = previous_[i];
    for (CornerSet* set : {&convex_, &without_area_, &may_be_ear_}) set->assign(i, false);
    is_out_of_the_way(i);
    if (!in_its_way_.empty()) in_its_way_[i] = kNone;
    take_new_neighbors(previous_[i]);
    take_new_neighbors(next_[i]);
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t count() const { return static_cast<std::uint32_t>(points_.size()); }

  /// Returns the corners that are not convex.
  std::vector<std::uint32_t> link_and_classify() {
    for (std::uint32_t i = 0; i < count(); ++i) {
      next_[i] = (i + 1) % count();
      previous_[next_[i]] = i;
    }
    std::vector<std::uint32_t> not_convex;
    for (std::uint32_t i = 0; i < count(); ++i) {
      if (classify(i) <= 0.0) not_convex.push_back(i);
    }
    return not_convex;
  }

  double classify(std::uint32_t i) {
    const double area = ear_area(i);
    convex_.assign(i, area > 0.0);
    may_be_ear_.assign(i, area > 0.0);
    without_area_.assign(i, area == 0.0);
    return area;
  }

  /// Returns whether a convex corner is an ear, that is, whether its closed triangle contains no
  /// other corner. It suffices to examine corners that are not convex, and a convex corner stays
  /// convex (Eberly 2002). A corner that coincides with one of the triangle's own (a bridge to a
  /// hole) does not count.
  bool is_ear(std::uint32_t i) {
    const auto found =
        not_convex_.find_in_triangle(points_[previous_[i]], points_[i], points_[next_[i]]);
    if (!found) return true;
    in_its_way_[i] = *found;
    in_the_way_of_[*found].push_back(i);
    return false;
  }

  /// Updates corner i after a change of its neighbors.
  void take_new_neighbors(std::uint32_t i) {
    if (classify(i) > 0.0) is_out_of_the_way(i);
    if (!in_its_way_.empty()) in_its_way_[i] = kNone;
  }

  /// Updates the corners that corner i blocked, which may be ears now that it is gone or convex.
  void is_out_of_the_way(std::uint32_t i) {
    if (!not_convex_.has(i)) return;
    not_convex_.remove(i);
    for (const std::uint32_t j : in_the_way_of_[i]) {
      if (in_its_way_[j] == i) may_be_ear_.assign(j, true);
    }
  }

  std::vector<glm::dvec2> points_;
  std::vector<std::uint32_t> next_;
  std::vector<std::uint32_t> previous_;
  CornerSet convex_;
  CornerSet without_area_;
  CornerSet may_be_ear_;  ///< convex, and not known to be blocked
  CornerTree not_convex_;
  std::vector<std::uint32_t> in_its_way_;                  ///< what blocks a corner's ear
  std::vector<std::vector<std::uint32_t>> in_the_way_of_;  ///< the corners that a corner blocks
};

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
    const auto corner = ring.next_to_clip(start);
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

#include "accel/polygon_beam/polygon_tree.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "scenes/base/error.hpp"

namespace beambench::accel::polygon_beam {
namespace {

using Corners = std::vector<glm::dvec3>;

/// A triangle in a cell while the tree is built.
struct Part {
  std::uint32_t triangle;
  bool in_face = false;  ///< lies in a plane that bounds the cell, so it is no longer counted
  bool is_whole = true;  ///< otherwise it was cut, and `outer` and `inner` remain
  Corners outer{};
  Corners inner{};
};

/// Returns the part of a convex polygon where sign * distance >= -slack (Sutherland and Hodgman).
Corners clipped(std::span<const glm::dvec3> corners, const Plane& plane, double sign,
                double slack) {
  Corners part;
  if (corners.empty()) return part;
  glm::dvec3 last = corners.back();
  double last_value = sign * plane.distance(last) + slack;
  for (const glm::dvec3& corner : corners) {
    const double value = sign * plane.distance(corner) + slack;
    if ((value >= 0.0) != (last_value >= 0.0)) {
      part.push_back(last + (corner - last) * (last_value / (last_value - value)));
    }
    if (value >= 0.0) part.push_back(corner);
    last = corner;
    last_value = value;
  }
  return part;
}

/// The smallest and the largest distance of corners from a plane.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
};
Range distances(std::span<const glm::dvec3> corners, const Plane& plane) {
  Range range;
  for (const glm::dvec3& corner : corners) {
    const double distance = plane.distance(corner);
    range.low = std::min(range.low, distance);
    range.high = std::max(range.high, distance);
  }
  return range;
}

glm::dvec3 twice_area(std::span<const glm::dvec3> corners) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 2; i < corners.size(); ++i) {
    sum += glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
  }
  return sum;
}

}  // namespace

/// Builds a tree from the root down.
class TreeBuilder {
 public:
  TreeBuilder(PolygonTree& tree, const TreeOptions& options) : tree_(&tree), options_(options) {}

  void operator()() {
    std::vector<Part> parts(tree_->scene_->triangles.size());
    for (std::size_t i = 0; i < parts.size(); ++i)
      parts[i].triangle = static_cast<std::uint32_t>(i);
    tree_->nodes_.emplace_back();
    build(0, std::move(parts), 1);
  }

 private:
  /// The polygons of a cell that supply candidate planes: the largest ones and a few others.
  static constexpr std::size_t kLargest = 4;
  static constexpr std::size_t kOthers = 4;

  /// Returns the corners of a part: its own, or, if it was not cut, those of its triangle, which
  /// are stored in `whole`.
  std::span<const glm::dvec3> outer_of(const Part& part, PolygonTree::Triangle& whole) const {
    if (!part.is_whole) return part.outer;
    whole = tree_->triangle(part.triangle);
    return whole;
  }
  Range distances_of(const Part& part, const Plane& plane) const {
    PolygonTree::Triangle whole;
    return distances(outer_of(part, whole), plane);
  }

  void build(std::size_t index, std::vector<Part> parts, std::size_t depth) {
    tree_->depth_ = std::max(tree_->depth_, depth);
    Box box{glm::dvec3(std::numeric_limits<double>::infinity()),
            glm::dvec3(-std::numeric_limits<double>::infinity())};
    for (const Part& part : parts) {
      PolygonTree::Triangle whole;
      for (const glm::dvec3& corner : outer_of(part, whole)) {
        box.lower = glm::min(box.lower, corner);
        box.upper = glm::max(box.upper, corner);
      }
    }
    tree_->nodes_[index].box = box;
    const auto plane = depth <= options_.max_depth ? choose(parts) : std::nullopt;
    if (!plane) return make_leaf(index, parts);

    std::array<std::vector<Part>, 2> sides;
    for (Part& part : parts) {
      auto front = beside(part, *plane, 1.0);
      auto back = beside(part, *plane, -1.0);
      if (front) sides[0].push_back(std::move(*front));
      if (back) sides[1].push_back(std::move(*back));
    }
    parts = {};
    // The number of parts is a lower bound of the references below this node.
    require_room(sides[0].size() + sides[1].size());
    const auto first = static_cast<std::uint32_t>(tree_->nodes_.size());
    tree_->nodes_.resize(first + 2UL);
    TreeNode& node = tree_->nodes_[index];
    node.is_leaf = false;
    node.plane = *plane;
    node.first = first;
    build(first, std::move(sides[0]), depth + 1);
    build(first + 1UL, std::move(sides[1]), depth + 1);
  }

  void make_leaf(std::size_t index, std::span<const Part> parts) {
    require_room(parts.size());
    tree_->nodes_[index].first = static_cast<std::uint32_t>(tree_->fragments_.size());
    tree_->nodes_[index].count = static_cast<std::uint32_t>(parts.size());
    for (const Part& part : parts) {
      Fragment& fragment = tree_->fragments_.emplace_back(Fragment{part.triangle});
      if (part.is_whole) continue;
      auto& corners = tree_->corners_;
      fragment.first = static_cast<std::uint32_t>(corners.size());
      fragment.outer = static_cast<std::uint16_t>(part.outer.size());
      fragment.inner = static_cast<std::uint16_t>(part.inner.size());
      corners.insert(corners.end(), part.outer.begin(), part.outer.end());
      corners.insert(corners.end(), part.inner.begin(), part.inner.end());
    }
  }

  void require_room(std::size_t more) const {
    if (tree_->fragments_.size() + more <= options_.max_references) return;
    throw InputError(fmt::format(
        "the BSP tree over '{}' ({} triangles) has more than max_references={} fragments of "
        "polygons; raise max_polygons, lower max_depth, or raise max_references",
        tree_->scene_->name, tree_->scene_->triangles.size(), options_.max_references));
  }

  /// Returns the portion of a part that a child refers to; nothing if the part is not within the
  /// slab.
  std::optional<Part> beside(const Part& part, const Plane& plane, double sign) const {
    const double slab = tree_->slab_;
    PolygonTree::Triangle whole;
    const std::span<const glm::dvec3> corners = outer_of(part, whole);
    const Range between = distances(corners, plane);
    const double low = sign > 0.0 ? between.low : -between.high;
    const double high = sign > 0.0 ? between.high : -between.low;
    if (high < -slab) return std::nullopt;
    Part kept;
    if (low >= -0.5 * slab) {
      kept = part;
    } else {
      kept.triangle = part.triangle;
      kept.is_whole = false;
      kept.outer = clipped(corners, plane, sign, slab);
      if (kept.outer.empty()) return std::nullopt;
      kept.inner = clipped(part.is_whole ? corners : std::span<const glm::dvec3>(part.inner), plane,
                           sign, 0.5 * slab);
    }
    // The part lies in the plane, or only its edge is on this side.
    kept.in_face = part.in_face || high <= slab;
    return kept;
  }

  /// Returns the plane that divides a cell; nothing if it should be a leaf.
  std::optional<Plane> choose(std::span<const Part> parts) const {
    std::vector<const Part*> counted;
    for (const Part& part : parts) {
      if (!part.in_face) counted.push_back(&part);
    }
    if (counted.size() <= options_.max_polygons) return std::nullopt;
    std::optional<Plane> best;
    // The score of a plane with all parts on one side, which gains nothing.
    double best_score = 2.0 * static_cast<double>(counted.size());
    for (const Plane& plane : candidates(counted)) {
      const double score = score_of(plane, counted);
      if (score < best_score) {
        best_score = score;
        best = plane;
      }
    }
    return best;
  }

  std::vector<Plane> candidates(std::span<const Part* const> parts) const {
    std::vector<Plane> planes;
    // Add the planes across each axis below which half of the polygons begin or end.
    std::vector<Range> extents(parts.size());
    const auto middle = extents.begin() + static_cast<std::ptrdiff_t>(extents.size() / 2);
    for (int axis = 0; axis < 3; ++axis) {
      Plane across;
      across.normal[axis] = 1.0;
      std::ranges::transform(parts, extents.begin(),
                             [&](const Part* part) { return distances_of(*part, across); });
      std::ranges::nth_element(extents, middle, {}, &Range::low);
      planes.push_back({across.normal, middle->low});
      std::ranges::nth_element(extents, middle, {}, &Range::high);
      planes.push_back({across.normal, middle->high});
    }

    std::vector<std::pair<double, const Part*>> areas;
    areas.reserve(parts.size());
    for (const Part* part : parts) {
      PolygonTree::Triangle whole;
      areas.emplace_back(glm::length(twice_area(outer_of(*part, whole))), part);
    }
    for (std::size_t i = 0; i < kOthers; ++i) {
      add_plane_of(*areas[i * areas.size() / kOthers].second, planes);
    }
    const std::size_t largest = std::min(kLargest, areas.size());
    std::ranges::partial_sort(areas, areas.begin() + static_cast<std::ptrdiff_t>(largest),
                              [](const auto& a, const auto& b) { return a.first > b.first; });
    for (std::size_t i = 0; i < largest; ++i) add_plane_of(*areas[i].second, planes);
    return planes;
  }

  void add_plane_of(const Part& part, std::vector<Plane>& planes) const {
    const PolygonTree::Triangle corners = tree_->triangle(part.triangle);
    const glm::dvec3 normal = twice_area(corners);
    const double length = glm::length(normal);
    if (!(length > 0.0)) return;
    planes.push_back({normal / length, glm::dot(normal / length, corners[0])});
  }

  /// Returns the number of parts that the two children would count; those of the larger child count
  /// twice.
  double score_of(const Plane& plane, std::span<const Part* const> parts) const {
    std::size_t front = 0;
    std::size_t back = 0;
    for (const Part* part : parts) {
      const Range between = distances_of(*part, plane);
      front += between.high > tree_->slab_ ? 1 : 0;
      back += between.low < -tree_->slab_ ? 1 : 0;
    }
    return static_cast<double>(front + back + std::max(front, back));
  }

  PolygonTree* tree_;
  TreeOptions options_;
};

PolygonTree::PolygonTree(const scenes::Scene& scene, const TreeOptions& options)
    : scene_(&scene),
      slab_(scene.bounds.empty() ? 0.0
                                 : 0x1p-16 * glm::length(glm::dvec3(scene.bounds.upper) -
                                                         glm::dvec3(scene.bounds.lower))) {
  TreeBuilder(*this, options)();
  nodes_.shrink_to_fit();
  fragments_.shrink_to_fit();
  corners_.shrink_to_fit();
}

PolygonTree::Triangle PolygonTree::triangle(std::uint32_t index) const {
  const auto& vertex = scene_->triangles[index].vertex;
  return {glm::dvec3(scene_->vertices[vertex[0]]), glm::dvec3(scene_->vertices[vertex[1]]),
          glm::dvec3(scene_->vertices[vertex[2]])};
}

std::size_t PolygonTree::bytes() const {
  return nodes_.capacity() * sizeof(TreeNode) + fragments_.capacity() * sizeof(Fragment) +
         corners_.capacity() * sizeof(glm::dvec3);
}

}  // namespace beambench::accel::polygon_beam

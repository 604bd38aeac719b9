#pragma once
// Clips triangles by boxes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "accel/core/overlap.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel {

/// A convex polygon during clipping. Each of the six planes adds at most one corner to a triangle's
/// three; if rounding makes the polygon cross a plane several times, a plane adds at most half as
/// many corners as there are.
struct ClippedPolygon {
  std::array<glm::dvec3, 28> corners;
  std::size_t count = 0;

  void add(const glm::dvec3& corner) { corners[count++] = corner; }

  /// Returns the box of the corners; there must be at least one corner.
  Box bounds() const {
    Box bounds{corners[0], corners[0]};
    for (std::size_t i = 1; i < count; ++i) {
      bounds.lower = glm::min(bounds.lower, corners[i]);
      bounds.upper = glm::max(bounds.upper, corners[i]);
    }
    return bounds;
  }

  double area() const {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 2; i < count; ++i) {
      sum += glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    }
    return 0.5 * glm::length(sum);
  }
};

/// Writes to `kept` the part on the side of the plane where sign * coordinate >= sign * plane.
inline void clip(const ClippedPolygon& polygon, int axis, double plane, double sign,
                 ClippedPolygon& kept) {
  kept.count = 0;
  const auto inside = [&](const glm::dvec3& point) {
    return sign * (glm::value_ptr(point)[axis] - plane);
  };
  glm::dvec3 from = polygon.corners[polygon.count - 1];
  double from_inside = inside(from);
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const glm::dvec3 to = polygon.corners[i];
    const double to_inside = inside(to);
    if ((from_inside < 0.0) != (to_inside < 0.0)) {
      glm::dvec3 crossing = from + (to - from) * (from_inside / (from_inside - to_inside));
      glm::value_ptr(crossing)[axis] = plane;
      kept.add(crossing);
    }
    if (to_inside >= 0.0) kept.add(to);
    from = to;
    from_inside = to_inside;
  }
}

/// Returns the part of a triangle that lies in a closed box, exact up to double rounding
/// (Sutherland and Hodgman, "Reentrant Polygon Clipping", 1974); without corners if no part does.
inline ClippedPolygon clipped_triangle(const scenes::Scene& scene, const scenes::Triangle& triangle,
                                       const Box& box) {
  std::array<ClippedPolygon, 2> polygons;
  ClippedPolygon* polygon = &polygons[0];
  ClippedPolygon* other = &polygons[1];
  const glm::dvec3 first(scene.vertices[triangle.vertex[0]]);
  Box whole{first, first};
  for (const std::uint32_t vertex : triangle.vertex) {
    const glm::dvec3 corner(scene.vertices[vertex]);
    polygon->add(corner);
    whole.lower = glm::min(whole.lower, corner);
    whole.upper = glm::max(whole.upper, corner);
  }
  const auto clip_by = [&](int axis, double plane, double sign) {
    clip(*polygon, axis, plane, sign, *other);
    std::swap(polygon, other);
    return polygon->count > 0;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = box.lower[axis];
    const double upper = box.upper[axis];
    if (whole.lower[axis] < lower && !clip_by(axis, lower, 1.0)) return *polygon;
    if (whole.upper[axis] > upper && !clip_by(axis, upper, -1.0)) return *polygon;
  }
  return *polygon;
}

}  // namespace beambench::accel

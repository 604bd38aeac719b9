#include "accel/bvh/clip.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace beambench::accel::bvh {
namespace {

/// A convex polygon during clipping. Each of the six planes adds at most one corner to those of a
/// triangle; if rounding made it cross a plane several times, at most half of the corners.
struct ClippedPolygon {
  std::array<glm::dvec3, 28> corners;
  std::size_t count = 0;

  void add(const glm::dvec3& corner) { corners[count++] = corner; }
};

/// Writes to `kept` the part on the side of the plane where sign * coordinate >= sign * plane.
void clip(const ClippedPolygon& polygon, int axis, double plane, double sign,
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

Box bounds_of(const ClippedPolygon& polygon) {
  Box bounds{polygon.corners[0], polygon.corners[0]};
  for (std::size_t i = 1; i < polygon.count; ++i) {
    bounds.lower = glm::min(bounds.lower, polygon.corners[i]);
    bounds.upper = glm::max(bounds.upper, polygon.corners[i]);
  }
  return bounds;
}

/// Returns the intersection of two boxes; nothing if it is empty.
std::optional<Box> common(const Box& a, const Box& b) {
  const Box part{glm::max(a.lower, b.lower), glm::min(a.upper, b.upper)};
  for (int axis = 0; axis < 3; ++axis) {
    if (part.lower[axis] > part.upper[axis]) return std::nullopt;
  }
  return part;
}

std::optional<Box> clipped_triangle(const scenes::Scene& scene, const scenes::Triangle& triangle,
                                    const Box& box) {
  std::array<ClippedPolygon, 2> polygons;
  ClippedPolygon* polygon = &polygons[0];
  ClippedPolygon* other = &polygons[1];
  for (const std::uint32_t vertex : triangle.vertex) {
    polygon->add(glm::dvec3(scene.vertices[vertex]));
  }
  const auto clip_by = [&](int axis, double plane, double sign) {
    clip(*polygon, axis, plane, sign, *other);
    std::swap(polygon, other);
    return polygon->count > 0;
  };
  const Box whole = bounds_of(*polygon);
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = box.lower[axis];
    const double upper = box.upper[axis];
    if (whole.lower[axis] < lower && !clip_by(axis, lower, 1.0)) return std::nullopt;
    if (whole.upper[axis] > upper && !clip_by(axis, upper, -1.0)) return std::nullopt;
  }
  // A crossing with one plane may be rounded to lie beyond another.
  return common(bounds_of(*polygon), box);
}

/// Returns the part of the ball: along an axis it extends as far as at the points of the box's
/// other two sides that are nearest to the center.
std::optional<Box> clipped_sphere(const scenes::Sphere& sphere, const Box& box) {
  if (!sphere_overlaps(sphere, box, 0.0)) return std::nullopt;
  const glm::dvec3 center(sphere.center);
  const double radius = sphere.radius;
  const glm::dvec3 outside = center - glm::clamp(center, box.lower, box.upper);
  const glm::dvec3 square = outside * outside;
  const double rest = radius * radius - (square.x + square.y + square.z);
  const glm::dvec3 reach = glm::sqrt(glm::max(glm::dvec3(rest) + square, glm::dvec3(0.0)));
  return common({center - reach, center + reach}, box);
}

}  // namespace

std::optional<Box> clipped_bounds(const scenes::Scene& scene, const PrimitivePart& piece,
                                  const Box& box) {
  switch (scene.primitives[piece.primitive].kind) {
    case scenes::PrimitiveKind::kPolygon:
      return clipped_triangle(scene, scene.triangles[piece.index], box);
    case scenes::PrimitiveKind::kSphere:
      return clipped_sphere(scene.spheres[piece.index], box);
    case scenes::PrimitiveKind::kCone:
      break;
  }
  if (!cone_overlaps(scene.cones[piece.index], box, 0.0)) return std::nullopt;
  return whole_bounds(scene, piece, box);
}

std::optional<Box> whole_bounds(const scenes::Scene& scene, const PrimitivePart& piece,
                                const Box& box) {
  const scenes::Bounds whole = part_bounds(scene, piece);
  return common({glm::dvec3(whole.lower), glm::dvec3(whole.upper)}, box);
}

}  // namespace beambench::accel::bvh

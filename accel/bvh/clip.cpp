#include "accel/bvh/clip.hpp"

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include "accel/core/clipped_polygon.hpp"

namespace beambench::accel::bvh {
namespace {

/// Returns the intersection of two boxes, or nothing if it is empty.
std::optional<Box> common(const Box& a, const Box& b) {
  const Box part{glm::max(a.lower, b.lower), glm::min(a.upper, b.upper)};
  for (int axis = 0; axis < 3; ++axis) {
    if (part.lower[axis] > part.upper[axis]) return std::nullopt;
  }
  return part;
}

std::optional<Box> clipped_triangle_bounds(const scenes::Scene& scene,
                                           const scenes::Triangle& triangle, const Box& box) {
  const ClippedPolygon polygon = clipped_triangle(scene, triangle, box);
  if (polygon.count == 0) return std::nullopt;
  // A crossing with one plane may be rounded to lie beyond another plane.
  return common(polygon.bounds(), box);
}

/// Returns the bounds of the ball's part in the box. Along each axis, this is the ball's extent at
/// the point nearest to the center on the box's other two sides.
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
      return clipped_triangle_bounds(scene, scene.triangles[piece.index], box);
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

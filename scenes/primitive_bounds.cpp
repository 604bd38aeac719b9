#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "scenes/scene.hpp"

namespace beambench::scenes {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The largest float that is not above a + b. Knuth's two-sum gives what the sum in double lost.
float sum_rounded_down(double a, double b) {
  const double sum = a + b;
  const double part = sum - a;
  const double lost = (a - (sum - part)) + (b - part);
  const auto rounded = static_cast<float>(sum);
  const double excess = static_cast<double>(rounded) - sum;  // exact: the two are that close
  return excess > lost ? std::nextafter(rounded, -kInfinity) : rounded;
}

float sum_rounded_up(double a, double b) { return -sum_rounded_down(-a, -b); }

Bounds box_around(const glm::vec3& center, const glm::dvec3& half_size) {
  Bounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    bounds.lower[axis] = sum_rounded_down(center[axis], -half_size[axis]);
    bounds.upper[axis] = sum_rounded_up(center[axis], half_size[axis]);
  }
  return bounds;
}

Bounds cone_bounds(const Cone& cone) {
  // A disc of radius r and unit normal n reaches r sqrt(1 - n_i^2) along axis i. The factor covers
  // the few roundings of this computation.
  constexpr double kOutward = 1.0 + 0x1p-48;
  const glm::dvec3 axis = glm::dvec3(cone.apex) - glm::dvec3(cone.base);
  const glm::dvec3 square = axis * axis;
  const glm::dvec3 across(square.y + square.z, square.z + square.x, square.x + square.y);
  const glm::dvec3 reach = glm::sqrt(across / (square.x + square.y + square.z)) * kOutward;
  Bounds bounds = box_around(cone.base, static_cast<double>(cone.base_radius) * reach);
  bounds.include(box_around(cone.apex, static_cast<double>(cone.apex_radius) * reach));
  return bounds;
}

Bounds polygon_bounds(const Scene& scene, const Polygon& polygon) {
  Bounds bounds;
  for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
    bounds.include(scene.vertices[scene.corners[polygon.first_corner + i]]);
  }
  return bounds;
}

}  // namespace

Bounds primitive_bounds(const Scene& scene, PrimitiveId id) {
  const Primitive& primitive = scene.primitives[id];
  switch (primitive.kind) {
    case PrimitiveKind::kSphere: {
      const Sphere& sphere = scene.spheres[primitive.index];
      return box_around(sphere.center, glm::dvec3(sphere.radius));
    }
    case PrimitiveKind::kCone:
      return cone_bounds(scene.cones[primitive.index]);
    case PrimitiveKind::kPolygon:
      break;
  }
  return polygon_bounds(scene, scene.polygons[primitive.index]);
}

}  // namespace beambench::scenes

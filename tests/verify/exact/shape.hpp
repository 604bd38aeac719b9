#pragma once
// The primitives of a scene in exact arithmetic.

#include <algorithm>
#include <variant>
#include <vector>

#include <glm/common.hpp>

#include "scenes/bounds.hpp"
#include "scenes/scene.hpp"
#include "tests/verify/exact/vector.hpp"

namespace beambench::exact {

struct Triangle {
  Vector a, b, c;
  Vector normal;  ///< of any length
};

struct Polygon {
  std::vector<Triangle> triangles;
};

struct Sphere {
  Vector center;
  Number radius;
  bool inside_only;
};

/// A lateral surface. Points x on it have |across|^2 = r^2, where h = (x - base) . axis, across is
/// the part of x - base perpendicular to the axis, and r = base_radius + taper h / length_2.
struct Cone {
  Vector base, apex;
  Vector axis;      ///< from base to apex
  Number length_2;  ///< |axis|^2
  Number base_radius, apex_radius;
  Number taper;    ///< apex radius - base radius
  double stretch;  ///< slant length / |axis|, rounded
  bool inside_only;
};

using Shape = std::variant<Polygon, Sphere, Cone>;

struct Solid {
  Shape shape;
  glm::dvec3 lower, upper;  ///< bounds, which may be slightly too large
};

inline Polygon polygon_of(const scenes::Scene& scene, const scenes::Polygon& polygon) {
  Polygon made;
  for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
    const scenes::Triangle& triangle = scene.triangles[polygon.first_triangle + i];
    const auto corner = [&](std::size_t k) {
      return Vector(glm::dvec3(scene.vertices[triangle.vertex[k]]));
    };
    Triangle exact{corner(0), corner(1), corner(2), {}};
    exact.normal = cross(exact.b - exact.a, exact.c - exact.a);
    made.triangles.push_back(std::move(exact));
  }
  return made;
}

inline Cone cone_of(const scenes::Cone& cone) {
  Cone made{Vector(glm::dvec3(cone.base)),
            Vector(glm::dvec3(cone.apex)),
            {},
            {},
            double{cone.base_radius},
            double{cone.apex_radius},
            {},
            1.0,
            cone.inside_only};
  made.axis = made.apex - made.base;
  made.length_2 = square(made.axis);
  made.taper = made.apex_radius - made.base_radius;
  made.stretch = std::sqrt(1.0 + made.taper.squared().rounded() / made.length_2.rounded());
  return made;
}

inline std::vector<Solid> solids_of(const scenes::Scene& scene) {
  std::vector<Solid> solids;
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    const scenes::Primitive& primitive = scene.primitives[id];
    const scenes::Bounds bounds = scenes::primitive_bounds(scene, id);
    Solid solid{{}, glm::dvec3(bounds.lower), glm::dvec3(bounds.upper)};
    switch (primitive.kind) {
      case scenes::PrimitiveKind::kSphere: {
        const scenes::Sphere& sphere = scene.spheres[primitive.index];
        solid.shape =
            Sphere{Vector(glm::dvec3(sphere.center)), double{sphere.radius}, sphere.inside_only};
        break;
      }
      case scenes::PrimitiveKind::kCone:
        solid.shape = cone_of(scene.cones[primitive.index]);
        break;
      case scenes::PrimitiveKind::kPolygon:
        solid.shape = polygon_of(scene, scene.polygons[primitive.index]);
        break;
    }
    solids.push_back(std::move(solid));
  }
  return solids;
}

}  // namespace beambench::exact

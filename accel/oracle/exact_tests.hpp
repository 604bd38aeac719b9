#pragma once
// Ray-primitive tests in double precision for Embree's user geometry. They use different formulas
// from the canonical tests of the classic structures, so that each exposes mistakes in the other.

#include <optional>

#include <glm/vec3.hpp>

#include "accel/core/ray.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::oracle {

/// A ray with its floats converted to double.
struct ExactRay {
  explicit ExactRay(const Ray& ray) : origin(ray.origin), direction(ray.direction), floats(ray) {}

  bool contains(double t) const { return in_interval(floats, t); }

  glm::dvec3 origin;
  glm::dvec3 direction;
  Ray floats;
};

/// Returns the smallest t in the ray's interval at which the ray hits the primitive, if any.
/// Triangles are two-sided and closed; rays through a shared edge hit one of its triangles.
std::optional<double> first_hit(const ExactRay& ray, const scenes::Scene& scene,
                                const scenes::Triangle& triangle);
std::optional<double> first_hit(const ExactRay& ray, const scenes::Sphere& sphere);
std::optional<double> first_hit(const ExactRay& ray, const scenes::Cone& cone);

/// A box in double precision.
struct ExactBounds {
  glm::dvec3 lower;
  glm::dvec3 upper;
};

ExactBounds bounds_of(const scenes::Scene& scene, const scenes::Triangle& triangle);
ExactBounds bounds_of(const scenes::Sphere& sphere);
/// Returns loose bounds: the box of the spheres around the cone's ends.
ExactBounds bounds_of(const scenes::Cone& cone);

}  // namespace beambench::accel::oracle

#pragma once
// The planar mirrors and the planar glass of a scene.

#include <vector>

#include <glm/vec3.hpp>

#include "scenes/bounds.hpp"
#include "scenes/scene.hpp"

namespace beambench::scenes {

/// Coplanar flat-shaded polygons, such as those of a mirror.
struct PlanarSurface {
  glm::dvec3 point;   ///< a point of the plane
  glm::dvec3 normal;  ///< the plane's normal, of unit length
  std::vector<PrimitiveId> polygons;
  Bounds bounds{};  ///< the bounds of the polygons
};

/// Returns a scene's planar mirrors, ordered by their lowest primitive ids. Each mirror combines
/// all coplanar flat-shaded polygons whose surface has a specular factor. Plane and polygons agree
/// up to float rounding (2^-22 for their normals, and for their distances relative to the scene's
/// largest coordinate), so that all rays from one point are reflected as if they came from its
/// image behind the mirror. A polygon whose corners are not coplanar is not a mirror.
std::vector<PlanarSurface> planar_mirrors(const Scene& scene);

/// Returns the refracting planes of a scene in the same way: each combines all coplanar flat-shaded
/// polygons with the same transparent surface.
std::vector<PlanarSurface> planar_glass(const Scene& scene);

}  // namespace beambench::scenes

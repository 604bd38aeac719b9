#pragma once
// The planar mirrors of a scene.

#include <vector>

#include <glm/vec3.hpp>

#include "scenes/bounds.hpp"
#include "scenes/scene.hpp"

namespace beambench::scenes {

/// Flat-shaded polygons of one plane whose surfaces reflect.
struct PlanarMirror {
  glm::dvec3 point;   ///< of the plane
  glm::dvec3 normal;  ///< of the plane, unit length
  std::vector<PrimitiveId> polygons;
  Bounds bounds{};  ///< of the polygons
};

/// A scene's planar mirrors, by the lowest primitive id: flat-shaded polygons whose surface has a
/// specular factor, those of one plane together. Plane and polygons agree to the rounding of floats
/// (their normals, and their distances as parts of the scene's largest coordinate, to 2^-22), so
/// that all rays from one point are reflected as if they came from its image behind the mirror. A
/// polygon whose corners do not lie in a plane is none.
std::vector<PlanarMirror> planar_mirrors(const Scene& scene);

}  // namespace beambench::scenes

#pragma once
// How a claimed hit lies on the primitive it names: the geometry behind the differ's classes.

#include "accel/core/ray.hpp"
#include "accel/embree/oracle.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// A claimed hit measured against its primitive, in double.
struct Contact {
  /// How far the claim is from a true hit: the larger of the distance of the point at t from the
  /// primitive's surface (continued beyond its boundary) and the distance by which the ray passes
  /// beside the primitive. Infinite where the ray may not hit at all: at the entry into a primitive
  /// that is seen from the inside only.
  double offset;
  /// |cos| of the angle between the ray and the surface normal there.
  double cosine;
  /// Does the ray leave the sphere or cone there? False for polygons, which have no inside.
  bool leaving;
};

/// `grazing` is the distance from a silhouette within which entry and exit cannot be distinguished.
Contact contact(const scenes::Scene& scene, const accel::Ray& ray,
                const accel::embree::ExactHit& hit, double grazing);

/// The distance from the line of the ray to the primitive's boundary as the ray sees it: the
/// nearest edge of a polygon's triangles, the silhouette of a sphere, silhouette or rims of a cone.
double boundary_distance(const scenes::Scene& scene, const accel::Ray& ray,
                         scenes::PrimitiveId primitive);

}  // namespace beambench::verify

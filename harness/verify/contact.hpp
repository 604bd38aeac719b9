#pragma once
// How a ray meets a primitive, measured in long double: near which point, and how far from the
// primitive's boundary.

#include <limits>
#include <vector>

#include "accel/core/ray.hpp"
#include "accel/oracle/oracle.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// A claimed hit measured against its primitive.
struct Contact {
  /// K u at the hit, but at least what the arithmetic of the tests in double can resolve there.
  double tolerance;
  /// The distance of the claim from a true hit: the larger of the distance of the point at t from
  /// the primitive's surface (continued beyond its boundary) and the distance by which the ray
  /// passes beside the primitive. Infinite where the point is more than `kAlong` tolerances away
  /// from the primitive's box, and where the ray may not hit at all: at the entry into a primitive
  /// that is seen from the inside only.
  double offset = std::numeric_limits<double>::infinity();
  /// |cos| of the angle between the ray and the surface normal there.
  double cosine = 0.0;
  /// Does the ray leave the sphere or cone there? False for polygons, which have no inside.
  bool leaving = false;

  bool is_on_primitive() const { return offset <= tolerance; }
};

/// Measures a hit against the primitive that it names, in long double.
Contact contact(const scenes::Scene& scene, const accel::Ray& ray,
                const accel::oracle::ExactHit& hit);

/// Returns `Contact::tolerance` at a hit.
double tolerance(const scenes::Scene& scene, const accel::Ray& ray,
                 const accel::oracle::ExactHit& hit);

/// The place where the line of a ray comes closest to a part of a primitive's boundary.
struct Approach {
  double distance;
  double t;
};

/// One approach to each edge of a polygon's triangles, or to the silhouette of a sphere, or to the
/// silhouette and the rims of a cone, as the ray sees them. A part that the line does not pass is
/// left out.
std::vector<Approach> approaches(const scenes::Scene& scene, const accel::Ray& ray,
                                 scenes::PrimitiveId primitive);

/// The least distance of all approaches; infinite without any.
double boundary_distance(const scenes::Scene& scene, const accel::Ray& ray,
                         scenes::PrimitiveId primitive);

}  // namespace beambench::verify

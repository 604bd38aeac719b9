#pragma once
// Measures, in long double, how a ray meets a primitive: near which point, and how far from the
// primitive's boundary.

#include <limits>
#include <vector>

#include "accel/core/ray.hpp"
#include "accel/oracle/oracle.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// A claimed hit measured against its primitive.
struct Contact {
  /// K u at the hit, but at least the resolution of the tests in double there.
  double tolerance;
  /// The distance of the claim from a true hit: the larger of the distance of the point at t from
  /// the primitive's surface (continued beyond its boundary) and the distance by which the ray
  /// passes beside the primitive. Infinite if the point is more than `kAlong` tolerances away from
  /// the primitive's box, or if a hit is impossible: at the entry into a primitive that is seen
  /// from the inside only.
  double offset = std::numeric_limits<double>::infinity();
  /// |cos| of the angle between the ray and the surface normal there.
  double cosine = 0.0;
  /// Whether the ray leaves the sphere or cone there. False for polygons, which have no inside.
  bool leaving = false;

  bool is_on_primitive() const { return offset <= tolerance; }
};

/// Measures a hit against its claimed primitive, in long double.
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

/// Returns one approach to each edge of a polygon's triangles, or to the silhouette of a sphere, or
/// to the silhouette and the rims of a cone, as seen along the ray. A part that the line does not
/// pass is left out.
std::vector<Approach> approaches(const scenes::Scene& scene, const accel::Ray& ray,
                                 scenes::PrimitiveId primitive);

/// Returns the smallest distance of all approaches; infinite if there are none.
double boundary_distance(const scenes::Scene& scene, const accel::Ray& ray,
                         scenes::PrimitiveId primitive);

}  // namespace beambench::verify

#pragma once
// The verification of one ray: by rules where they suffice, by the long-double search where not.

#include <cstddef>
#include <optional>
#include <vector>

#include "accel/core/ray.hpp"
#include "accel/embree/oracle.hpp"
#include "harness/verify/differ.hpp"
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

/// The closest hit in the ray's closed interval, ties to the lowest primitive id, by testing every
/// primitive in long double (64-bit mantissa on x86) with code that neither the structures nor the
/// oracle share. Slow: some 20 ns a primitive.
std::optional<accel::embree::ExactHit> exact_closest_hit(const scenes::Scene& scene,
                                                         const accel::Ray& ray);

/// All hits in the interval, in the order of primitives, by the same tests.
std::vector<accel::embree::ExactHit> exact_hits(const scenes::Scene& scene, const accel::Ray& ray);

/// K u for rays from `origin`: the length within which points cannot be distinguished in float.
double tolerance(const scenes::Scene& scene, const glm::vec3& origin);

/// The class of an answer against a reference answer by the first three rules of `DiffClass`
/// (agree, tie, graze), `tolerance` being K u; nothing when none of them applies and the results
/// are in dispute.
std::optional<DiffClass> classify(const scenes::Scene& scene, const accel::Ray& ray,
                                  const std::optional<accel::Hit>& answer,
                                  const std::optional<accel::embree::ExactHit>& reference,
                                  double tolerance);

/// Is the hit invalid: a primitive that the scene does not have, or a t that is not a number in the
/// ray's interval? `t` of a miss is infinity.
bool is_invalid(const scenes::Scene& scene, const accel::Ray& ray, const accel::Hit& answer);

/// The ray at an index of an input with the structure's answer and the oracle's, not yet
/// classified. An answer that is neither hit nor miss is kept as it is.
Mismatch candidate_mismatch(const rays::TraceInput& input, const rays::TraceResults& results,
                            std::size_t index,
                            const std::optional<accel::embree::ExactHit>& oracle);

/// Sets class and reason by the first three rules, or where the answer is invalid; false where they
/// leave a dispute. `tolerance` is K u.
bool classify_by_rules(const scenes::Scene& scene, double tolerance, Mismatch& found);

/// Sets class and reason of a dispute by the long-double search over all primitives.
void classify_by_search(const scenes::Scene& scene, double tolerance, Mismatch& found);

/// A baseline's answer: only a miss is right.
void classify_as_baseline(Mismatch& found);

/// All of it for one ray, `found` as `candidate_mismatch` returns it.
void verify_ray(const scenes::Scene& scene, accel::Conformance conformance, Mismatch& found);

}  // namespace beambench::verify

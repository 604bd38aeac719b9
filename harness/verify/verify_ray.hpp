#pragma once
// The verification of one ray: by rules where they suffice, by the long-double search where not.

#include <cstddef>
#include <optional>

#include "harness/verify/differ.hpp"

namespace beambench::verify {

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

/// The ray at an index of a input with the structure's answer and the oracle's, not yet
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

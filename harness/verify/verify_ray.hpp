#pragma once
// The verification of one ray: by the oracle where it agrees, by exact arithmetic where not.

#include <cstddef>
#include <optional>

#include "accel/core/ray.hpp"
#include "accel/core/registry.hpp"
#include "accel/oracle/oracle.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/verify/diff_report.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// Is the hit invalid: a primitive that the scene does not have, or a t that is not a number in the
/// ray's interval? `t` of a miss is infinity.
bool is_invalid(const scenes::Scene& scene, const accel::Ray& ray, const accel::Hit& answer);

/// The ray at an index of an input with the structure's answer and the oracle's, not yet
/// classified. An answer that is neither hit nor miss is kept as it is.
Mismatch candidate_mismatch(const rays::TraceInput& input, const rays::TraceResults& results,
                            std::size_t index,
                            const std::optional<accel::oracle::ExactHit>& oracle);

/// Sets class and reason where the answer agrees with the oracle's, is within K u of it along the
/// ray on another primitive, or is invalid; false where it is in dispute.
bool classify_by_oracle(const scenes::Scene& scene, Mismatch& found);

/// Sets class and reason of a dispute by exact arithmetic. A hit is right when its point lies
/// within K u of the primitive that it names, and each crossing before it is either at one place
/// with it or grazed. A miss is right when every crossing is grazed. Two places are one where they
/// are within K u of each other across the surface, and 1024 K u along the ray. A crossing is
/// grazed where the primitive's boundary is within K u of the ray, or the crossing is at one place
/// with an end of the ray's interval.
void classify_by_search(const scenes::Scene& scene, Mismatch& found);

/// A baseline's answer: only a miss is right.
void classify_as_baseline(Mismatch& found);

/// All of it for one ray, `found` as `candidate_mismatch` returns it.
void verify_ray(const scenes::Scene& scene, accel::Conformance conformance, Mismatch& found);

}  // namespace beambench::verify

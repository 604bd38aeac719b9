#pragma once
// Verifies one ray: by the oracle if it agrees, otherwise by exact arithmetic.

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

/// Returns whether the hit is invalid: a primitive that is not in the scene, or a t that is not a
/// number in the ray's interval. `t` of a miss is infinity.
bool is_invalid(const scenes::Scene& scene, const accel::Ray& ray, const accel::Hit& answer);

/// Returns the ray at an index of an input with the structure's result and the oracle's, not yet
/// classified. A result that is neither hit nor miss is kept as it is.
Mismatch candidate_mismatch(const rays::TraceInput& input, const rays::TraceResults& results,
                            std::size_t index,
                            const std::optional<accel::oracle::ExactHit>& oracle);

/// Sets class and reason if the result agrees with the oracle's, is within K u of it along the ray
/// on another primitive, or is invalid; returns false if the result is disputed.
bool classify_by_oracle(const scenes::Scene& scene, Mismatch& found);

/// Sets class and reason of a dispute by exact arithmetic. A hit is correct if its point lies
/// within K u of its primitive, and each crossing before it is either at one place with it or
/// grazed. A miss is correct if every crossing is grazed. Two places are one if they are within K u
/// of each other across the surface, and within 1024 K u along the ray. A crossing is grazed if the
/// primitive's boundary is within K u of the ray, or the crossing is at one place with an end of
/// the ray's interval. A grazed miss of a ray that must hit has leaked.
void classify_by_search(const scenes::Scene& scene, Mismatch& found);

/// Classifies a baseline's result: only a miss is correct.
void classify_as_baseline(Mismatch& found);

/// Classifies one ray by these functions; `found` is as returned by `candidate_mismatch`.
void verify_ray(const scenes::Scene& scene, accel::Conformance conformance, Mismatch& found);

}  // namespace beambench::verify

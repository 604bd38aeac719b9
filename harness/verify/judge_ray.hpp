#pragma once
// The judgment of one ray: by rules where they suffice, by the long-double search where not.

#include <cstddef>
#include <optional>

#include "harness/verify/differ.hpp"

namespace beambench::verify {

/// The ray at an index of a question, the structure's answer, and the oracle's, not yet judged. An
/// answer that is neither hit nor miss is kept as it stands.
Mismatch ask_again(const rays::Question& question, const rays::Answers& answers, std::size_t index,
                   const std::optional<accel::embree::ExactHit>& oracle);

/// Sets class and reason by the first three rules, or where the answer is none at all; false where
/// they leave a dispute. `tolerance` is K u.
bool settle_by_rules(const scenes::Scene& scene, double tolerance, Mismatch& found);

/// Settles a dispute by the long-double search.
void adjudicate(const scenes::Scene& scene, double tolerance, Mismatch& found);

/// A baseline's answer: only a miss is right.
void settle_as_baseline(Mismatch& found);

/// The class by the rules, where they suffice, otherwise by the search: all of it for one ray:
/// `found` as `ask_again` returns it.
void judge_ray(const scenes::Scene& scene, accel::Conformance conformance, Mismatch& found);

}  // namespace beambench::verify

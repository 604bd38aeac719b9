#pragma once
// The verification of one ray: by rules where they suffice, by the long-double search where not.

#include <cstddef>
#include <optional>

#include "harness/verify/differ.hpp"

namespace beambench::verify {

/// K u for rays from `origin`: the length within which places cannot be told apart in float.
double tolerance(const scenes::Scene& scene, const glm::vec3& origin);

/// The class of an answer against a reference answer by the first three rules of `DiffClass`
/// (agree, tie, graze), `tolerance` being K u; nothing when none of them
/// applies and the answers are in dispute. A hit only passes at all when it is sound: when its
/// point lies within K u of the primitive it names.
std::optional<DiffClass> classify(const scenes::Scene& scene, const accel::Ray& ray,
                                  const std::optional<accel::Hit>& answer,
                                  const std::optional<accel::embree::ExactHit>& reference,
                                  double tolerance);

/// Could a little change of the numbers have made this hit or unmade it: is its primitive's
/// boundary within `tolerance` of the ray, or an end of the ray within it of the surface?
bool grazes(const scenes::Scene& scene, const accel::Ray& ray, const accel::embree::ExactHit& hit,
            double tolerance);

/// Is the answer none at all: a primitive the scene does not have, or a t that is not a number in
/// the ray's interval? `t` of a miss is infinity.
bool is_nonsense(const scenes::Scene& scene, const accel::Ray& ray, const accel::Hit& answer);

/// The ray at an index of an input, the structure's result, and the oracle's, not yet judged. An
/// answer that is neither hit nor miss is kept as it stands.
Mismatch ask_again(const rays::TraceInput& input, const rays::TraceResults& results,
                   std::size_t index, const std::optional<accel::embree::ExactHit>& oracle);

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

/// Agreement with the oracle, or an answer that is neither 0 nor 1; false for a dispute.
bool settle_any_hit_by_rules(Mismatch& found);

/// Settles a dispute by a search through all primitives in long double. A structure that says "no
/// hit" is right when there is none, and only grazes when every hit there is does. One that says
/// "some hit" is right when there is one, and grazes when the ray passes within `tolerance` (K u)
/// of a primitive.
void adjudicate_any_hit(const scenes::Scene& scene, double tolerance, Mismatch& found);

}  // namespace beambench::verify

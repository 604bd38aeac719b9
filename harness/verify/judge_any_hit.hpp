#pragma once
// The judgment of one answer to an any-hit query.

#include "harness/verify/differ.hpp"

namespace beambench::verify {

/// Agreement with the oracle, or an answer that is neither 0 nor 1; false for a dispute.
bool settle_any_hit_by_rules(Mismatch& found);

/// Settles a dispute by a search through all primitives in long double. A structure that says "no
/// hit" is right when there is none, and only grazes when every hit there is does. One that says
/// "some hit" is right when there is one, and grazes when the ray passes within `tolerance` (K u)
/// of a primitive.
void adjudicate_any_hit(const scenes::Scene& scene, double tolerance, Mismatch& found);

}  // namespace beambench::verify

#pragma once
// A search through all primitives in long double, which decides disputes.

#include <optional>
#include <vector>

#include "accel/core/ray.hpp"
#include "accel/embree/oracle.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// The closest hit in the ray's closed interval, ties to the lowest primitive id, by testing every
/// primitive in long double (64-bit mantissa on x86) with code that neither the structures nor the
/// oracle share. Slow: some 20 ns a primitive.
std::optional<accel::embree::ExactHit> exact_closest_hit(const scenes::Scene& scene,
                                                         const accel::Ray& ray);

/// All hits in the interval, in the order of primitives, by the same tests.
std::vector<accel::embree::ExactHit> exact_hits(const scenes::Scene& scene, const accel::Ray& ray);

}  // namespace beambench::verify

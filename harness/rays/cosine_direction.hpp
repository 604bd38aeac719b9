#pragma once
// A random direction by the cosine with a normal.

#include <glm/vec3.hpp>

#include "scenes/core/random.hpp"

namespace beambench::rays {

/// A unit vector with density cos / pi in the hemisphere about the unit vector `normal` (Malley's
/// method: a uniform point of the unit disc, lifted to the hemisphere; Pharr, Jakob and Humphreys,
/// Physically Based Rendering, 4th ed., A.5.3).
glm::dvec3 cosine_direction(const glm::dvec3& normal, Random& random);

}  // namespace beambench::rays

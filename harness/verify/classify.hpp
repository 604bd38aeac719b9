#pragma once
// The differ's classes for one ray: rules that need no search through the scene.

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

}  // namespace beambench::verify

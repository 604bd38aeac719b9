#pragma once
// Exact results of closest-hit queries, and the classes of other results.

#include <optional>
#include <vector>

#include "harness/verify/exact_search.hpp"
#include "harness/verify/verify_ray.hpp"

namespace beambench::tests {

/// Returns the first crossing in the ray's interval.
inline std::optional<accel::oracle::ExactHit> exact_closest_hit(const scenes::Scene& scene,
                                                                const accel::Ray& ray) {
  const std::vector<verify::Crossing> found =
      verify::crossings(scene, ray, verify::primitives_near(scene, ray));
  return found.empty() ? std::nullopt : std::optional(found.front().hit());
}

/// Returns kAgree, kTie or kGraze by exact arithmetic, or nullopt for a wrong result.
inline std::optional<verify::DiffClass> class_of(const scenes::Scene& scene, const accel::Ray& ray,
                                                 const std::optional<accel::Hit>& answer) {
  verify::Mismatch found{};
  found.ray = ray;
  found.query = rays::Query::kClosestHit;
  found.answer = answer;
  verify::classify_by_search(scene, found);
  switch (found.diff_class) {
    case verify::DiffClass::kStructureError:
      return std::nullopt;
    case verify::DiffClass::kOracleError:  // of the miss that replaces the oracle's result
      return verify::DiffClass::kAgree;
    default:
      return found.diff_class;
  }
}

}  // namespace beambench::tests

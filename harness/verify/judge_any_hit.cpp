#include "harness/verify/judge_any_hit.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

#include "harness/verify/classify.hpp"
#include "harness/verify/contact.hpp"
#include "harness/verify/exact_search.hpp"

namespace beambench::verify {
namespace {

/// The same ray with K u more at both ends.
accel::Ray lengthened(const accel::Ray& ray, double tolerance) {
  const auto more = static_cast<float>(tolerance / glm::length(glm::dvec3(ray.direction)));
  accel::Ray longer = ray;
  longer.t_min = std::max(0.0F, ray.t_min - more);
  longer.t_max = ray.t_max + more;
  return longer;
}

/// Does the ray's interval reach the box of the primitive, widened by the tolerance?
bool reaches(const scenes::Scene& scene, const accel::Ray& ray, scenes::PrimitiveId id,
             double tolerance) {
  const scenes::Bounds box = scenes::primitive_bounds(scene, id);
  double enter = ray.t_min;
  double leave = ray.t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const double origin = ray.origin[axis];
    const double direction = ray.direction[axis];
    const double lower = box.lower[axis] - tolerance;
    const double upper = box.upper[axis] + tolerance;
    if (direction == 0.0) {
      if (origin < lower || origin > upper) return false;
      continue;
    }
    const auto [near, far] =
        std::minmax({(lower - origin) / direction, (upper - origin) / direction});
    enter = std::max(enter, near);
    leave = std::min(leave, far);
  }
  return enter <= leave;
}

/// Does the ray touch some primitive so lightly that it might as well not?
bool touches_something(const scenes::Scene& scene, const accel::Ray& ray, double tolerance) {
  if (exact_closest_hit(scene, lengthened(ray, tolerance))) return true;
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    if (reaches(scene, ray, id, tolerance) && boundary_distance(scene, ray, id) <= tolerance) {
      return true;
    }
  }
  return false;
}

void settle(Mismatch& found, DiffClass diff_class, std::string_view reason) {
  found.diff_class = diff_class;
  found.reason = reason;
}

void settle_no_hit(const scenes::Scene& scene, double tolerance, Mismatch& found) {
  bool all_graze = true;
  for (const accel::embree::ExactHit& hit : exact_hits(scene, found.ray)) {
    all_graze = all_graze && grazes(scene, found.ray, hit, tolerance);
  }
  if (!found.exact) {
    settle(found, DiffClass::kEmbreeError, "there is no hit, as the structure says");
  } else if (all_graze) {
    settle(found, DiffClass::kGraze, "all that is hit is only grazed, or touched at the ray's end");
  } else {
    settle(found, DiffClass::kEngineError, "the structure lost a hit");
  }
}

void settle_some_hit(const scenes::Scene& scene, double tolerance, Mismatch& found) {
  if (found.exact) {
    settle(found, DiffClass::kEmbreeError, "there is a hit, as the structure says");
  } else if (touches_something(scene, found.ray, tolerance)) {
    settle(found, DiffClass::kGraze, "a primitive is just missed, or just beyond the ray's end");
  } else {
    settle(found, DiffClass::kEngineError, "the structure reports a hit where there is none");
  }
}

}  // namespace

bool settle_any_hit_by_rules(Mismatch& found) {
  if (found.engine_any_hit > 1) {
    settle(found, DiffClass::kEngineError, "no such answer exists: it is neither 0 nor 1");
    return true;
  }
  if ((found.engine_any_hit == 1) != found.oracle.has_value()) return false;
  found.diff_class = DiffClass::kAgree;
  return true;
}

void adjudicate_any_hit(const scenes::Scene& scene, double tolerance, Mismatch& found) {
  found.adjudicated = true;
  found.exact = exact_closest_hit(scene, found.ray);
  found.engine_any_hit == 1 ? settle_some_hit(scene, tolerance, found)
                            : settle_no_hit(scene, tolerance, found);
}

}  // namespace beambench::verify

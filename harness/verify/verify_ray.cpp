#include "harness/verify/verify_ray.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "harness/verify/contact.hpp"
#include "harness/verify/exact_search.hpp"

namespace beambench::verify {
namespace {

constexpr double kUnits = 16.0;  // K: about four times the worst residual that was measured

/// One ray and the length within which two places are one.
struct Measure {
  const scenes::Scene& scene;
  const accel::Ray& ray;
  double tolerance;

  /// |dt| in the units of lengths.
  double gap(double t0, double t1) const {
    return std::abs(t0 - t1) * glm::length(glm::dvec3(ray.direction));
  }
  Contact contact_of(const accel::embree::ExactHit& hit) const {
    return contact(scene, ray, hit, tolerance);
  }

  bool grazes(const accel::embree::ExactHit& hit) const {
    const double cosine = contact_of(hit).cosine;
    return gap(hit.t, ray.t_min) * cosine <= tolerance ||
           gap(hit.t, ray.t_max) * cosine <= tolerance ||
           boundary_distance(scene, ray, hit.primitive) <= tolerance;
  }
};

/// Rules 1 and 2: two hits that are one place.
std::optional<DiffClass> same_place(const Measure& measure, const accel::embree::ExactHit& answer,
                                    const accel::embree::ExactHit& reference) {
  const Contact claimed = measure.contact_of(answer);
  const Contact expected = measure.contact_of(reference);
  const double apart =
      measure.gap(answer.t, reference.t) * std::min(claimed.cosine, expected.cosine);
  if (answer.primitive != reference.primitive) {
    return apart <= measure.tolerance ? std::optional(DiffClass::kTie) : std::nullopt;
  }
  // On a sphere or cone |dt| says little near the silhouette; two points of its surface are the
  // same crossing when the ray enters at both or leaves at both.
  const bool curved =
      measure.scene.primitives[answer.primitive].kind != scenes::PrimitiveKind::kPolygon;
  const bool same_crossing = curved && claimed.leaving == expected.leaving;
  return same_crossing || apart <= measure.tolerance ? std::optional(DiffClass::kAgree)
                                                     : std::nullopt;
}

std::string_view why_wrong(const scenes::Scene& scene, double tolerance, const Mismatch& found) {
  if (!found.engine) return "the structure lost a hit";
  const accel::embree::ExactHit claim{found.engine->t, found.engine->primitive};
  if (!(contact(scene, found.ray, claim, tolerance).offset <= tolerance)) {
    return "the ray does not meet the structure's primitive at its t";
  }
  if (!found.exact || claim.t < found.exact->t) return "the structure reports a hit too many";
  return "the structure lost a nearer hit";
}

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

double tolerance(const scenes::Scene& scene, const glm::vec3& origin) {
  return kUnits * 0x1p-24 * (scene.bounds.largest_coordinate() + glm::length(glm::dvec3(origin)));
}

std::optional<DiffClass> classify(const scenes::Scene& scene, const accel::Ray& ray,
                                  const std::optional<accel::Hit>& answer,
                                  const std::optional<accel::embree::ExactHit>& reference,
                                  double tolerance) {
  if (!answer && !reference) return DiffClass::kAgree;
  const Measure measure{scene, ray, tolerance};
  std::optional<accel::embree::ExactHit> claim;
  if (answer) {
    claim = accel::embree::ExactHit{answer->t, answer->primitive};
    if (!(measure.contact_of(*claim).offset <= tolerance)) return std::nullopt;
    if (reference) {
      if (const auto found = same_place(measure, *claim, *reference)) return found;
    }
  }
  // In dispute is the nearer hit: one side saw it and the other did not.
  const bool extra = claim && (!reference || claim->t < reference->t);
  if (measure.grazes(extra ? *claim : *reference)) return DiffClass::kGraze;
  return std::nullopt;
}

bool grazes(const scenes::Scene& scene, const accel::Ray& ray, const accel::embree::ExactHit& hit,
            double tolerance) {
  return Measure{scene, ray, tolerance}.grazes(hit);
}

bool is_nonsense(const scenes::Scene& scene, const accel::Ray& ray, const accel::Hit& answer) {
  if (answer.primitive == scenes::kNoPrimitive) return answer.t != accel::kInfinity;
  return answer.primitive >= scene.primitives.size() || !std::isfinite(answer.t) ||
         answer.t < ray.t_min || answer.t > ray.t_max;
}

Mismatch ask_again(const rays::TraceInput& input, const rays::TraceResults& results,
                   std::size_t index, const std::optional<accel::embree::ExactHit>& oracle) {
  Mismatch found{};
  found.index = index;
  found.ray = input.ray(index);
  found.query = input.query();
  found.oracle = oracle;
  if (const auto* any = std::get_if<rays::AnyHits>(&results)) {
    found.engine_any_hit = (*any)[index];
  } else {
    const auto& hits = std::get<accel::HitBuffer>(results);
    const accel::Hit answer{hits.t()[index], hits.primitive()[index]};
    if (answer != accel::Hit{accel::kInfinity, scenes::kNoPrimitive}) found.engine = answer;
  }
  return found;
}

bool settle_by_rules(const scenes::Scene& scene, double tolerance, Mismatch& found) {
  if (found.query == rays::Query::kAnyHit) return settle_any_hit_by_rules(found);
  if (found.engine && is_nonsense(scene, found.ray, *found.engine)) {
    found.diff_class = DiffClass::kEngineError;
    found.reason = "no such answer exists: the primitive or t is out of range";
    return true;
  }
  const auto by_rules = classify(scene, found.ray, found.engine, found.oracle, tolerance);
  if (!by_rules) return false;
  found.diff_class = *by_rules;
  if (*by_rules == DiffClass::kTie) found.reason = "both primitives are hit at one place";
  if (*by_rules == DiffClass::kGraze) {
    found.reason = "the disputed primitive is only grazed, or touched at the ray's end";
  }
  return true;
}

void adjudicate(const scenes::Scene& scene, double tolerance, Mismatch& found) {
  if (found.query == rays::Query::kAnyHit) return adjudicate_any_hit(scene, tolerance, found);
  found.adjudicated = true;
  found.exact = exact_closest_hit(scene, found.ray);
  const bool right = classify(scene, found.ray, found.engine, found.exact, tolerance).has_value();
  found.diff_class = right ? DiffClass::kEmbreeError : DiffClass::kEngineError;
  found.reason = right ? "the structure gives the exact answer and the oracle does not"
                       : why_wrong(scene, tolerance, found);
}

void settle_as_baseline(Mismatch& found) {
  const bool silent = !found.engine && found.engine_any_hit == 0;
  found.diff_class = silent ? DiffClass::kAgree : DiffClass::kEngineError;
  if (!silent) found.reason = "this structure returns nothing by design, and here it did";
}

void judge_ray(const scenes::Scene& scene, accel::Conformance conformance, Mismatch& found) {
  if (conformance == accel::Conformance::kBaseline) return settle_as_baseline(found);
  const double length = tolerance(scene, found.ray.origin);
  if (!settle_by_rules(scene, length, found)) adjudicate(scene, length, found);
}

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

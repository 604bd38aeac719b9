#include "harness/verify/verify_ray.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace beambench::verify {
namespace {

constexpr double kUnits = 16.0;  // K: about four times the worst residual that was measured

/// One ray and the length within which two points are one.
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

  /// Does the ray begin or end on the surface that is hit?
  bool touches(const accel::embree::ExactHit& hit) const {
    const double cosine = contact_of(hit).cosine;
    return gap(hit.t, ray.t_min) * cosine <= tolerance ||
           gap(hit.t, ray.t_max) * cosine <= tolerance;
  }

  bool grazes(const accel::embree::ExactHit& hit) const {
    return touches(hit) || boundary_distance(scene, ray, hit.primitive) <= tolerance;
  }
};

/// Rules 1 and 2: two hits at one point.
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

/// Sets class and reason.
void classify_as(DiffClass diff_class, std::string_view reason, Mismatch& found) {
  found.diff_class = diff_class;
  found.reason = reason;
}

std::string_view why_wrong(const scenes::Scene& scene, double tolerance, const Mismatch& found) {
  if (!found.answer) return "a hit was lost";
  const accel::embree::ExactHit claim{found.answer->t, found.answer->primitive};
  if (!(contact(scene, found.ray, claim, tolerance).offset <= tolerance)) {
    return "the ray does not meet that primitive at that t";
  }
  if (!found.exact || claim.t < found.exact->t) return "a hit too many is reported";
  return "a nearer hit was lost";
}

/// The whole line of a ray.
accel::Ray line_of(const accel::Ray& ray) {
  accel::Ray line = ray;
  line.t_min = -accel::kInfinity;
  line.t_max = accel::kInfinity;
  return line;
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

/// Does the ray, which hits nothing, graze some primitive, so that it might as well hit it? It does
/// where a hit would graze that is found.
bool grazes_something(const scenes::Scene& scene, const accel::Ray& ray, double tolerance) {
  const Measure measure{scene, ray, tolerance};
  if (std::ranges::any_of(exact_hits(scene, line_of(ray)),
                          [&](const auto& hit) { return measure.touches(hit); })) {
    return true;
  }
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    if (reaches(scene, ray, id, tolerance) && boundary_distance(scene, ray, id) <= tolerance) {
      return true;
    }
  }
  return false;
}

/// A structure that reports no hit is right when there is none, and only grazes when every hit
/// there is does. One that reports some hit is right when there is one, and grazes when the ray
/// passes within `tolerance` (K u) of a primitive.
void classify_any_hit_by_search(const scenes::Scene& scene, double tolerance, Mismatch& found) {
  const bool answer = found.any_hit_answer == 1;
  if (answer == found.exact.has_value()) {
    return classify_as(DiffClass::kEmbreeError,
                       answer ? "there is a hit, as reported" : "there is no hit, as reported",
                       found);
  }
  if (answer) {
    if (grazes_something(scene, found.ray, tolerance)) {
      return classify_as(DiffClass::kGraze,
                         "a primitive is just missed, or just beyond the ray's end", found);
    }
    return classify_as(DiffClass::kStructureError, "a hit is reported where there is none", found);
  }
  const Measure measure{scene, found.ray, tolerance};
  if (std::ranges::all_of(exact_hits(scene, found.ray),
                          [&](const auto& hit) { return measure.grazes(hit); })) {
    return classify_as(DiffClass::kGraze,
                       "all that is hit is only grazed, or touched at the ray's end", found);
  }
  classify_as(DiffClass::kStructureError, "a hit was lost", found);
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

bool is_invalid(const scenes::Scene& scene, const accel::Ray& ray, const accel::Hit& answer) {
  if (answer.primitive == scenes::kNoPrimitive) return answer.t != accel::kInfinity;
  return answer.primitive >= scene.primitives.size() || !std::isfinite(answer.t) ||
         answer.t < ray.t_min || answer.t > ray.t_max;
}

Mismatch candidate_mismatch(const rays::TraceInput& input, const rays::TraceResults& results,
                            std::size_t index,
                            const std::optional<accel::embree::ExactHit>& oracle) {
  Mismatch found{};
  found.index = index;
  found.ray = input.ray(index);
  found.query = input.query();
  found.oracle = oracle;
  if (const auto* any = std::get_if<rays::AnyHits>(&results)) {
    found.any_hit_answer = (*any)[index];
  } else {
    const auto& hits = std::get<accel::HitBuffer>(results);
    const accel::Hit answer{hits.t()[index], hits.primitive()[index]};
    if (answer != accel::Hit{accel::kInfinity, scenes::kNoPrimitive}) found.answer = answer;
  }
  return found;
}

bool classify_by_rules(const scenes::Scene& scene, double tolerance, Mismatch& found) {
  if (found.query == rays::Query::kAnyHit) {
    if (found.any_hit_answer > 1) {
      classify_as(DiffClass::kStructureError, "invalid answer: it is neither 0 nor 1", found);
      return true;
    }
    if ((found.any_hit_answer == 1) != found.oracle.has_value()) return false;
    found.diff_class = DiffClass::kAgree;
    return true;
  }
  if (found.answer && is_invalid(scene, found.ray, *found.answer)) {
    classify_as(DiffClass::kStructureError, "invalid hit: the primitive or t is out of range",
                found);
    return true;
  }
  const auto by_rules = classify(scene, found.ray, found.answer, found.oracle, tolerance);
  if (!by_rules) return false;
  found.diff_class = *by_rules;
  if (*by_rules == DiffClass::kTie) found.reason = "both primitives are hit at one point";
  if (*by_rules == DiffClass::kGraze) {
    found.reason = "the disputed primitive is only grazed, or touched at the ray's end";
  }
  return true;
}

void classify_by_search(const scenes::Scene& scene, double tolerance, Mismatch& found) {
  found.searched = true;
  found.exact = exact_closest_hit(scene, found.ray);
  if (found.query == rays::Query::kAnyHit) {
    return classify_any_hit_by_search(scene, tolerance, found);
  }
  if (classify(scene, found.ray, found.answer, found.exact, tolerance)) {
    return classify_as(DiffClass::kEmbreeError,
                       "the answer is the exact one and the oracle's is not", found);
  }
  classify_as(DiffClass::kStructureError, why_wrong(scene, tolerance, found), found);
}

void classify_as_baseline(Mismatch& found) {
  found.diff_class = DiffClass::kAgree;
  if (!found.answer && found.any_hit_answer == 0) return;
  classify_as(DiffClass::kStructureError,
              "this structure returns no hits by design, but here it did", found);
}

void verify_ray(const scenes::Scene& scene, accel::Conformance conformance, Mismatch& found) {
  if (conformance == accel::Conformance::kBaseline) return classify_as_baseline(found);
  const double length = tolerance(scene, found.ray.origin);
  if (!classify_by_rules(scene, length, found)) classify_by_search(scene, length, found);
}

}  // namespace beambench::verify

#include "harness/verify/verify_ray.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "harness/verify/contact.hpp"
#include "harness/verify/exact_search.hpp"
#include "harness/verify/tolerance.hpp"

namespace beambench::verify {
namespace {

using accel::oracle::ExactHit;

/// A hit of the ray and its contact with the primitive.
struct Place {
  ExactHit hit;
  Contact contact;
};

/// One ray over a scene, and the criteria for equal places on it.
struct Measure {
  const scenes::Scene& scene;
  const accel::Ray& ray;

  Place place_of(const ExactHit& hit) const { return {hit, contact(scene, ray, hit)}; }
  double length_between(double t0, double t1) const {
    return std::abs(t0 - t1) * glm::length(glm::dvec3(ray.direction));
  }
  bool at_one_place(const Place& place, double t) const {
    const double gap = length_between(place.hit.t, t);
    const double near = place.contact.tolerance;
    return gap * place.contact.cosine <= near && gap <= kAlong * near;
  }

  /// Returns whether the ray begins or ends on the surface that is hit.
  bool touches(const Place& place) const {
    return at_one_place(place, ray.t_min) || at_one_place(place, ray.t_max);
  }

  bool grazes(const Place& place) const {
    return touches(place) ||
           boundary_distance(scene, ray, place.hit.primitive) <= place.contact.tolerance;
  }
  bool all_are_grazed(const std::vector<Crossing>& crossings) const {
    return std::ranges::all_of(crossings,
                               [&](const Crossing& each) { return grazes(place_of(each.hit())); });
  }

  /// Returns whether two hits of one primitive are the same crossing. On a sphere or cone, |dt| is
  /// inconclusive near the silhouette; two points of its surface are the same crossing if the ray
  /// enters at both or leaves at both.
  bool is_same(const Place& claim, const Place& reference) const {
    const scenes::PrimitiveId id = claim.hit.primitive;
    if (id != reference.hit.primitive) return false;
    const double gap = length_between(claim.hit.t, reference.hit.t);
    if (gap * reference.contact.cosine <= claim.contact.tolerance) return true;
    return scene.primitives[id].kind != scenes::PrimitiveKind::kPolygon &&
           claim.contact.leaving == reference.contact.leaving;
  }

  /// Returns whether the ray passes the primitive's boundary within K u or crosses it, in both
  /// cases also just beyond an end.
  bool nearly_hits(scenes::PrimitiveId id) const {
    for (const Approach& approach : approaches(scene, ray, id)) {
      const Place place = place_of({approach.t, id});
      const bool inside = approach.t >= ray.t_min && approach.t <= ray.t_max;
      if (approach.distance <= place.contact.tolerance && (inside || touches(place))) return true;
    }
    return std::ranges::any_of(line_crossings(scene, ray, id), [&](const Crossing& crossing) {
      return touches(place_of(crossing.hit()));
    });
  }
};

std::optional<ExactHit> as_exact(const std::optional<accel::Hit>& hit) {
  return hit ? std::optional(ExactHit{hit->t, hit->primitive}) : std::nullopt;
}

/// Returns the class of a closest hit, or of a miss, by the crossings in order: kAgree, kTie or
/// kGraze; nothing if it is wrong.
std::optional<DiffClass> class_among(const Measure& measure, const std::vector<Crossing>& crossings,
                                     const std::optional<ExactHit>& answer) {
  if (!answer) {
    if (!measure.all_are_grazed(crossings)) return std::nullopt;
    return crossings.empty() ? DiffClass::kAgree : DiffClass::kGraze;
  }
  const Place claim = measure.place_of(*answer);
  if (!claim.contact.is_on_primitive()) return std::nullopt;
  DiffClass found = DiffClass::kAgree;
  for (const Crossing& crossing : crossings) {
    const Place place = measure.place_of(crossing.hit());
    if (measure.is_same(claim, place)) return found;
    if (crossing.t >= answer->t || measure.at_one_place(place, answer->t)) {
      found = std::max(found, DiffClass::kTie);
    } else if (measure.grazes(place)) {
      found = DiffClass::kGraze;
    } else {
      return std::nullopt;
    }
  }
  return DiffClass::kGraze;  // the claimed primitive is not crossed there
}

/// Sets class and reason.
void classify_as(DiffClass diff_class, std::string_view reason, Mismatch& found) {
  found.diff_class = diff_class;
  found.reason = reason;
}

std::string_view why_wrong(const Measure& measure, const Mismatch& found) {
  if (!found.answer) return "a hit was lost";
  const ExactHit claim{found.answer->t, found.answer->primitive};
  if (!measure.place_of(claim).contact.is_on_primitive()) {
    return found.exact && measure.at_one_place(measure.place_of(*found.exact), claim.t)
               ? "t is right, but another primitive is hit there"
               : "the ray does not meet that primitive at that t";
  }
  if (!found.exact || claim.t < found.exact->t) return "a hit is reported that does not exist";
  return "a nearer hit was lost";
}

/// Classifies an any-hit result. "No hit" is correct if there is no hit, and a graze if every
/// existing hit is only grazed. "Hit" is correct if there is a hit, and a graze if the ray nearly
/// hits something.
void classify_any_hit(const Measure& measure, const std::vector<scenes::PrimitiveId>& near,
                      const std::vector<Crossing>& crossings, Mismatch& found) {
  const bool answer = found.any_hit_answer == 1;
  const bool all_grazed = measure.all_are_grazed(crossings);
  const auto is_hit_nearly = [&] {
    return std::ranges::any_of(near,
                               [&](scenes::PrimitiveId id) { return measure.nearly_hits(id); });
  };
  if (answer != crossings.empty()) {  // correct, so the oracle is wrong
    const bool excused = answer ? all_grazed : is_hit_nearly();
    if (excused) return classify_as(DiffClass::kAgree, {}, found);
    return classify_as(DiffClass::kOracleError,
                       answer ? "there is a hit, as reported" : "there is no hit, as reported",
                       found);
  }
  if (answer) {
    if (is_hit_nearly()) {
      return classify_as(DiffClass::kGraze,
                         "a primitive is just missed, or just beyond the ray's end", found);
    }
    return classify_as(DiffClass::kStructureError, "a hit is reported where there is none", found);
  }
  if (all_grazed) {
    return classify_as(DiffClass::kGraze,
                       "all that is hit is only grazed, or touched at the ray's end", found);
  }
  classify_as(DiffClass::kStructureError, "a hit was lost", found);
}

void classify_closest_hit(const Measure& measure, const std::vector<Crossing>& crossings,
                          Mismatch& found) {
  const auto own = class_among(measure, crossings, as_exact(found.answer));
  if (!own) {
    return classify_as(DiffClass::kStructureError, why_wrong(measure, found), found);
  }
  if (*own == DiffClass::kTie) {
    return classify_as(*own, "both primitives are hit at one point", found);
  }
  if (*own == DiffClass::kGraze) {
    return classify_as(*own, "the disputed primitive is only grazed, or touched at the ray's end",
                       found);
  }
  if (class_among(measure, crossings, found.oracle)) {
    return classify_as(DiffClass::kAgree, {}, found);
  }
  classify_as(DiffClass::kOracleError, "the answer is the exact one and the oracle's is not",
              found);
}

}  // namespace

bool is_invalid(const scenes::Scene& scene, const accel::Ray& ray, const accel::Hit& answer) {
  if (answer.primitive == scenes::kNoPrimitive) return answer.t != accel::kInfinity;
  return answer.primitive >= scene.primitives.size() || !accel::in_interval(ray, answer.t);
}

Mismatch candidate_mismatch(const rays::TraceInput& input, const rays::TraceResults& results,
                            std::size_t index,
                            const std::optional<accel::oracle::ExactHit>& oracle) {
  Mismatch found{};
  found.index = index;
  found.ray = input.ray(index);
  found.query = input.query();
  found.must_hit = input.list() != nullptr && input.list()->must_hit;
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

bool classify_by_oracle(const scenes::Scene& scene, Mismatch& found) {
  if (found.query == rays::Query::kAnyHit) {
    if (found.any_hit_answer > 1) {
      classify_as(DiffClass::kStructureError, "invalid answer: it is neither 0 nor 1", found);
      return true;
    }
    found.diff_class = DiffClass::kAgree;
    return (found.any_hit_answer == 1) == found.oracle.has_value();
  }
  if (found.answer && is_invalid(scene, found.ray, *found.answer)) {
    classify_as(DiffClass::kStructureError, "invalid hit: the primitive or t is out of range",
                found);
    return true;
  }
  found.diff_class = DiffClass::kAgree;
  if (!found.answer || !found.oracle) return !found.answer && !found.oracle;
  const Measure measure{scene, found.ray};
  const Place claim = measure.place_of({found.answer->t, found.answer->primitive});
  if (!claim.contact.is_on_primitive()) return false;
  if (measure.is_same(claim, measure.place_of(*found.oracle))) return true;
  // Nothing lies in front of the oracle's hit, nor between two places that are so close.
  const double gap = measure.length_between(claim.hit.t, found.oracle->t);
  if (!(gap <= claim.contact.tolerance)) return false;
  classify_as(DiffClass::kTie, "both primitives are hit at one point", found);
  return true;
}

void classify_by_search(const scenes::Scene& scene, Mismatch& found) {
  found.searched = true;
  const Measure measure{scene, found.ray};
  const std::vector<scenes::PrimitiveId> near = primitives_near(scene, found.ray);
  const std::vector<Crossing> crossed = crossings(scene, found.ray, near);
  if (!crossed.empty()) found.exact = crossed.front().hit();
  if (found.query == rays::Query::kAnyHit) {
    classify_any_hit(measure, near, crossed, found);
  } else {
    classify_closest_hit(measure, crossed, found);
  }
  if (found.must_hit && found.diff_class == DiffClass::kGraze && found.is_miss()) {
    found.leaked = true;
    found.reason = "it left a closed surface where primitives meet, and must hit one of them";
  }
}

void classify_as_baseline(Mismatch& found) {
  found.diff_class = DiffClass::kAgree;
  if (!found.answer && found.any_hit_answer == 0) return;
  classify_as(DiffClass::kStructureError,
              "this structure returns no hits by design, but here it did", found);
}

void verify_ray(const scenes::Scene& scene, accel::Conformance conformance, Mismatch& found) {
  if (conformance == accel::Conformance::kBaseline) return classify_as_baseline(found);
  if (!classify_by_oracle(scene, found)) classify_by_search(scene, found);
}

}  // namespace beambench::verify

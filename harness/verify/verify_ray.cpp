#include "harness/verify/verify_ray.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "harness/verify/contact.hpp"
#include "harness/verify/exact_search.hpp"
#include "harness/verify/tolerance.hpp"

namespace beambench::verify {
namespace {

using accel::embree::ExactHit;

/// The least distance that the arithmetic of the tests in double can resolve, as a part of the
/// distance to the farthest point of a primitive.
constexpr double kLeastPart = 0x1p-50;

/// One ray over a scene, and what counts as one place on it.
struct Measure {
  const scenes::Scene& scene;
  const accel::Ray& ray;

  /// K u at a hit.
  double tolerance_of(const ExactHit& hit) const {
    const scenes::Bounds box = scenes::primitive_bounds(scene, hit.primitive);
    const glm::dvec3 origin(ray.origin);
    const glm::dvec3 reach = glm::max(glm::abs(glm::dvec3(box.lower) - origin),
                                      glm::abs(glm::dvec3(box.upper) - origin));
    return std::max(tolerance(ray, hit.t), kLeastPart * glm::length(reach));
  }
  Contact contact_of(const ExactHit& hit) const {
    return contact(scene, ray, hit, tolerance_of(hit));
  }
  bool at_one_place(const ExactHit& hit, double t) const {
    return verify::at_one_place(ray, hit.t, t, contact_of(hit).cosine, tolerance_of(hit));
  }

  /// Within K u of the primitive's surface, and not far from the primitive along it.
  bool is_on_primitive(const ExactHit& hit) const {
    const double near = tolerance_of(hit);
    if (!(contact(scene, ray, hit, near).offset <= near)) return false;
    const scenes::Bounds box = scenes::primitive_bounds(scene, hit.primitive);
    const glm::dvec3 point = glm::dvec3(ray.origin) + hit.t * glm::dvec3(ray.direction);
    const glm::dvec3 outside =
        glm::max(glm::dvec3(box.lower) - point, point - glm::dvec3(box.upper));
    return std::max({outside.x, outside.y, outside.z}) <= kAlong * near;
  }

  /// Does the ray begin or end on the surface that is hit?
  bool touches(const ExactHit& hit) const {
    return at_one_place(hit, ray.t_min) || at_one_place(hit, ray.t_max);
  }

  bool grazes(const ExactHit& hit) const {
    return touches(hit) || boundary_distance(scene, ray, hit.primitive) <= tolerance_of(hit);
  }

  /// Two hits of one primitive at one point. On a sphere or cone |dt| says little near the
  /// silhouette; two points of its surface are the same crossing when the ray enters at both or
  /// leaves at both.
  bool is_same(const ExactHit& claim, const ExactHit& reference) const {
    if (claim.primitive != reference.primitive) return false;
    const Contact expected = contact_of(reference);
    const double gap = std::abs(claim.t - reference.t) * glm::length(glm::dvec3(ray.direction));
    if (gap * expected.cosine <= tolerance_of(claim)) return true;
    return scene.primitives[claim.primitive].kind != scenes::PrimitiveKind::kPolygon &&
           contact_of(claim).leaving == expected.leaving;
  }

  /// Does the ray pass the primitive's boundary within K u, or cross it just beyond an end?
  bool nearly_hits(scenes::PrimitiveId id) const {
    const double length = glm::length(glm::dvec3(ray.direction));
    for (const Approach& approach : approaches(scene, ray, id)) {
      const double near = tolerance_of({approach.t, id});
      if (approach.distance <= near && approach.t >= ray.t_min - near / length &&
          approach.t <= ray.t_max + near / length) {
        return true;
      }
    }
    return std::ranges::any_of(line_crossings(scene, ray, id),
                               [&](const Crossing& crossing) { return touches(crossing.hit()); });
  }
};

std::optional<ExactHit> as_exact(const std::optional<accel::Hit>& hit) {
  return hit ? std::optional(ExactHit{hit->t, hit->primitive}) : std::nullopt;
}

/// Returns what `class_of` returns, for crossings in their order.
std::optional<DiffClass> class_among(const Measure& measure, const std::vector<Crossing>& crossings,
                                     const std::optional<ExactHit>& claim) {
  if (!claim) {
    const bool all_grazed = std::ranges::all_of(
        crossings, [&](const Crossing& each) { return measure.grazes(each.hit()); });
    if (!all_grazed) return std::nullopt;
    return crossings.empty() ? DiffClass::kAgree : DiffClass::kGraze;
  }
  if (!measure.is_on_primitive(*claim)) return std::nullopt;
  DiffClass found = DiffClass::kAgree;
  for (const Crossing& crossing : crossings) {
    const ExactHit hit = crossing.hit();
    if (measure.is_same(*claim, hit)) return found;
    if (hit.t >= claim->t || measure.at_one_place(hit, claim->t)) {
      found = std::max(found, DiffClass::kTie);
    } else if (measure.grazes(hit)) {
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
  if (!measure.is_on_primitive(claim)) return "the ray does not meet that primitive at that t";
  if (!found.exact || claim.t < found.exact->t) return "a hit too many is reported";
  return "a nearer hit was lost";
}

/// A structure that reports no hit is right when there is none, and only grazes when every hit
/// there is does. One that reports some hit is right when there is one, and grazes when the ray
/// nearly hits something.
void classify_any_hit(const Measure& measure, const std::vector<scenes::PrimitiveId>& near,
                      const std::vector<Crossing>& crossings, Mismatch& found) {
  const bool answer = found.any_hit_answer == 1;
  const bool all_grazed = std::ranges::all_of(
      crossings, [&](const Crossing& each) { return measure.grazes(each.hit()); });
  const auto is_hit_nearly = [&] {
    return std::ranges::any_of(near,
                               [&](scenes::PrimitiveId id) { return measure.nearly_hits(id); });
  };
  if (answer != crossings.empty()) {  // right, so the oracle is not
    const bool excused = answer ? all_grazed : is_hit_nearly();
    if (excused) return classify_as(DiffClass::kAgree, {}, found);
    return classify_as(DiffClass::kEmbreeError,
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
  classify_as(DiffClass::kEmbreeError, "the answer is the exact one and the oracle's is not",
              found);
}

}  // namespace

std::optional<DiffClass> class_of(const scenes::Scene& scene, const accel::Ray& ray,
                                  const std::optional<accel::Hit>& answer) {
  return class_among({scene, ray}, crossings(scene, ray, primitives_near(scene, ray)),
                     as_exact(answer));
}

bool is_invalid(const scenes::Scene& scene, const accel::Ray& ray, const accel::Hit& answer) {
  if (answer.primitive == scenes::kNoPrimitive) return answer.t != accel::kInfinity;
  return answer.primitive >= scene.primitives.size() || !accel::in_interval(ray, answer.t);
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
  const ExactHit claim{found.answer->t, found.answer->primitive};
  if (!measure.is_on_primitive(claim)) return false;
  if (measure.is_same(claim, *found.oracle)) return true;
  // Nothing lies before the oracle's hit, nor between two places that are so close.
  const double gap =
      std::abs(claim.t - found.oracle->t) * glm::length(glm::dvec3(found.ray.direction));
  if (!(gap <= measure.tolerance_of(claim))) return false;
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

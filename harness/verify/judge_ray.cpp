#include "harness/verify/judge_ray.hpp"

#include "harness/verify/classify.hpp"
#include "harness/verify/contact.hpp"
#include "harness/verify/exact_search.hpp"
#include "harness/verify/judge_any_hit.hpp"

namespace beambench::verify {
namespace {

std::string_view why_wrong(const scenes::Scene& scene, double tolerance, const Mismatch& found) {
  if (!found.engine) return "the structure lost a hit";
  const accel::embree::ExactHit claim{found.engine->t, found.engine->primitive};
  if (!(contact(scene, found.ray, claim, tolerance).offset <= tolerance)) {
    return "the ray does not meet the structure's primitive at its t";
  }
  if (!found.exact || claim.t < found.exact->t) return "the structure reports a hit too many";
  return "the structure lost a nearer hit";
}

}  // namespace

Mismatch ask_again(const rays::Question& question, const rays::Answers& answers, std::size_t index,
                   const std::optional<accel::embree::ExactHit>& oracle) {
  Mismatch found{};
  found.index = index;
  found.ray = question.ray(index);
  found.query = question.query();
  found.oracle = oracle;
  if (const auto* any = std::get_if<rays::AnyHits>(&answers)) {
    found.engine_any_hit = (*any)[index];
  } else {
    const auto& hits = std::get<accel::HitBuffer>(answers);
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
  if (!silent) found.reason = "this structure answers nothing by design, and here it did";
}

void judge_ray(const scenes::Scene& scene, accel::Conformance conformance, Mismatch& found) {
  if (conformance == accel::Conformance::kBaseline) return settle_as_baseline(found);
  const double length = tolerance(scene, found.ray.origin);
  if (!settle_by_rules(scene, length, found)) adjudicate(scene, length, found);
}

}  // namespace beambench::verify

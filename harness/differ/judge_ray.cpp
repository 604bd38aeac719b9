#include "harness/differ/judge_ray.hpp"

#include "harness/differ/classify.hpp"
#include "harness/differ/contact.hpp"
#include "harness/differ/exact_search.hpp"
#include "harness/differ/judge_any_hit.hpp"

namespace beambench {
namespace {

std::string_view why_wrong(const Scene& scene, double tolerance, const Mismatch& found) {
  if (!found.engine) return "the structure lost a hit";
  const ExactHit claim{found.engine->t, found.engine->primitive};
  if (!(contact(scene, found.ray, claim, tolerance).offset <= tolerance)) {
    return "the ray does not meet the structure's primitive at its t";
  }
  if (!found.exact || claim.t < found.exact->t) return "the structure reports a hit too many";
  return "the structure lost a nearer hit";
}

}  // namespace

Mismatch ask_again(const Question& question, const Answers& answers, std::size_t index,
                   const std::optional<ExactHit>& oracle) {
  Mismatch found{};
  found.index = index;
  found.ray = question.ray(index);
  found.query = question.query();
  found.oracle = oracle;
  if (const auto* any = std::get_if<AnyHits>(&answers)) {
    found.engine_any_hit = (*any)[index];
  } else {
    const auto& hits = std::get<HitBuffer>(answers);
    const Hit answer{hits.t()[index], hits.primitive()[index]};
    if (answer != Hit{kInfinity, kNoPrimitive}) found.engine = answer;
  }
  return found;
}

bool settle_by_rules(const Scene& scene, double tolerance, Mismatch& found) {
  if (found.query == Query::kAnyHit) return settle_any_hit_by_rules(found);
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

void adjudicate(const Scene& scene, double tolerance, Mismatch& found) {
  if (found.query == Query::kAnyHit) return adjudicate_any_hit(scene, tolerance, found);
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

void judge_ray(const Scene& scene, Conformance conformance, Mismatch& found) {
  if (conformance == Conformance::kBaseline) return settle_as_baseline(found);
  const double length = tolerance(scene, found.ray.origin);
  if (!settle_by_rules(scene, length, found)) adjudicate(scene, length, found);
}

}  // namespace beambench

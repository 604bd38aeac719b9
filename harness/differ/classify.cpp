#include "harness/differ/classify.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "harness/differ/contact.hpp"

namespace beambench {
namespace {

constexpr double kUnits = 16.0;  // K: about four times the worst residual that was measured

/// One ray and the length within which two places are one.
struct Measure {
  const Scene& scene;
  const Ray& ray;
  double tolerance;

  /// |dt| in the units of lengths.
  double gap(double t0, double t1) const {
    return std::abs(t0 - t1) * glm::length(glm::dvec3(ray.direction));
  }
  Contact contact_of(const ExactHit& hit) const { return contact(scene, ray, hit, tolerance); }

  bool grazes(const ExactHit& hit) const {
    const double cosine = contact_of(hit).cosine;
    return gap(hit.t, ray.t_min) * cosine <= tolerance ||
           gap(hit.t, ray.t_max) * cosine <= tolerance ||
           boundary_distance(scene, ray, hit.primitive) <= tolerance;
  }
};

/// Rules 1 and 2: two hits that are one place.
std::optional<DiffClass> same_place(const Measure& measure, const ExactHit& answer,
                                    const ExactHit& reference) {
  const Contact claimed = measure.contact_of(answer);
  const Contact expected = measure.contact_of(reference);
  const double apart =
      measure.gap(answer.t, reference.t) * std::min(claimed.cosine, expected.cosine);
  if (answer.primitive != reference.primitive) {
    return apart <= measure.tolerance ? std::optional(DiffClass::kTie) : std::nullopt;
  }
  // On a sphere or cone |dt| says little near the silhouette; two points of its surface are the
  // same crossing when the ray enters at both or leaves at both.
  const bool curved = measure.scene.primitives[answer.primitive].kind != PrimitiveKind::kPolygon;
  const bool same_crossing = curved && claimed.leaving == expected.leaving;
  return same_crossing || apart <= measure.tolerance ? std::optional(DiffClass::kAgree)
                                                     : std::nullopt;
}

}  // namespace

double tolerance(const Scene& scene, const glm::vec3& origin) {
  return kUnits * 0x1p-24 * (scene.bounds.largest_coordinate() + glm::length(glm::dvec3(origin)));
}

std::optional<DiffClass> classify(const Scene& scene, const Ray& ray,
                                  const std::optional<Hit>& answer,
                                  const std::optional<ExactHit>& reference, double tolerance) {
  if (!answer && !reference) return DiffClass::kAgree;
  const Measure measure{scene, ray, tolerance};
  std::optional<ExactHit> claim;
  if (answer) {
    claim = ExactHit{answer->t, answer->primitive};
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

bool grazes(const Scene& scene, const Ray& ray, const ExactHit& hit, double tolerance) {
  return Measure{scene, ray, tolerance}.grazes(hit);
}

bool is_nonsense(const Scene& scene, const Ray& ray, const Hit& answer) {
  if (answer.primitive == kNoPrimitive) return answer.t != kInfinity;
  return answer.primitive >= scene.primitives.size() || !std::isfinite(answer.t) ||
         answer.t < ray.t_min || answer.t > ray.t_max;
}

}  // namespace beambench

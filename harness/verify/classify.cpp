#include "harness/verify/classify.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "harness/verify/contact.hpp"

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

}  // namespace beambench::verify

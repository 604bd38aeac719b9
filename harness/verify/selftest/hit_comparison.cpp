#include "harness/verify/selftest/hit_comparison.hpp"

#include <utility>

#include <fmt/format.h>

#include "harness/verify/describe.hpp"

namespace beambench::verify {
namespace {

/// What the differ reports of the results for an input. Rays that are aimed at edges and
/// corners graze, and there may be as many of them as there are.
std::string judged(const scenes::Scene& scene, const rays::TraceInput& input,
                   const rays::TraceResults& results, accel::Conformance conformance,
                   bool may_graze) {
  const DiffReport report = judge(ReferenceHits(scene, input), results, conformance);
  if (report.verdict == Verdict::kOk || report.verdict == Verdict::kBaseline) return "";
  if (report.verdict == Verdict::kGrazes && may_graze) return "";
  std::string text = fmt::format("the differ says '{}': {} of {} rays wrong, {} grazes",
                                 to_string(report.verdict), report.count(DiffClass::kEngineError),
                                 report.rays, report.count(DiffClass::kGraze));
  if (!report.examples.empty()) text += "; " + describe(scene, input, report.examples.front());
  return text;
}

}  // namespace

std::string show(const std::optional<accel::Hit>& hit) {
  return hit ? fmt::format("primitive {} at t {:a}", hit->primitive, hit->t) : "a miss";
}

std::string show(const accel::Ray& ray) {
  return fmt::format(
      "the ray from ({:a}, {:a}, {:a}) along ({:a}, {:a}, {:a}), t from {:a} to {:a}", ray.origin.x,
      ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z, ray.t_min,
      ray.t_max);
}

std::string HitComparison::same_bits(const accel::Accelerator& structure,
                                     const accel::Ray& ray) const {
  const auto expected = exhaustive_.closest_hit(ray, nullptr);
  const auto found = structure.closest_hit(ray, nullptr);
  if (found != expected) {
    return fmt::format("{} hits {} first, not {}", show(ray), show(expected), show(found));
  }
  const bool any = structure.any_hit(ray, nullptr);
  if (any != expected.has_value()) {
    return fmt::format("{} {}, but any_hit says {}", show(ray),
                       expected ? "hits something" : "hits nothing", any);
  }
  return "";
}

std::string HitComparison::single_rays(const accel::Accelerator& structure,
                                       std::span<const accel::Ray> rays) const {
  if (conformance_ != accel::Conformance::kBitExact) return by_the_differ(structure, rays);
  for (const accel::Ray& ray : rays) {
    if (std::string wrong = same_bits(structure, ray); !wrong.empty()) return wrong;
    const auto hit = exhaustive_.closest_hit(ray, nullptr);
    if (!hit) continue;
    accel::Ray ends_there = ray;
    ends_there.t_max = hit->t;
    accel::Ray begins_there = ray;
    begins_there.t_min = hit->t;
    for (const accel::Ray& cut : {ends_there, begins_there}) {
      if (std::string wrong = same_bits(structure, cut); !wrong.empty()) return wrong;
    }
  }
  return "";
}

std::string HitComparison::by_the_differ(const accel::Accelerator& structure,
                                         std::span<const accel::Ray> rays) const {
  for (const rays::Query query : {rays::Query::kClosestHit, rays::Query::kAnyHit}) {
    const rays::TraceInput input(
        rays::RaySet{"selftest", query, 0, std::nullopt, {rays.begin(), rays.end()}});
    rays::TraceResults results = rays::make_results(input);
    rays::poison(results);
    rays::trace(structure, input, results);
    std::string wrong = judged(*scene_, input, results, conformance_, /*may_graze=*/true);
    if (!wrong.empty()) return wrong;
  }
  return "";
}

std::string HitComparison::image(const accel::Accelerator& structure,
                                 const accel::PrimaryRays& rays, bool may_graze) const {
  const rays::TraceInput input(rays);
  rays::TraceResults results = rays::make_results(input);
  rays::poison(results);
  rays::trace(structure, input, results);
  if (conformance_ != accel::Conformance::kBitExact) {
    return judged(*scene_, input, results, conformance_, may_graze);
  }
  const auto& found = std::get<accel::HitBuffer>(results);
  accel::HitBuffer expected(rays.width(), rays.height(), rays.samples());
  exhaustive_.trace(rays, expected, nullptr);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (found.t()[i] == expected.t()[i] && found.primitive()[i] == expected.primitive()[i])
      continue;
    return fmt::format("{}: {} hits {} first, not {}", rays::place_text(input, i),
                       show(input.ray(i)), show(expected.get(i)),
                       show(accel::Hit{found.t()[i], found.primitive()[i]}));
  }
  return "";
}

std::size_t HitComparison::count_hits(std::span<const accel::Ray> rays) const {
  std::size_t hits = 0;
  for (const accel::Ray& ray : rays) hits += exhaustive_.any_hit(ray, nullptr) ? 1 : 0;
  return hits;
}

}  // namespace beambench::verify

#include "harness/selftest/hit_comparison.hpp"

#include <utility>

#include <fmt/format.h>

#include "harness/differ/differ.hpp"

namespace beambench {
namespace {

/// What the differ says of answers that were given to a question. Rays that are aimed at edges and
/// corners graze, and there may be as many of them as there are.
std::string judged(const Scene& scene, const Question& question, const Answers& answers,
                   Conformance conformance, bool may_graze) {
  const DiffReport report = judge(ReferenceHits(scene, question), answers, conformance);
  if (report.verdict == Verdict::kOk || report.verdict == Verdict::kBaseline) return "";
  if (report.verdict == Verdict::kGrazes && may_graze) return "";
  std::string text = fmt::format("the differ says '{}': {} of {} rays wrong, {} grazes",
                                 to_string(report.verdict), report.count(DiffClass::kEngineError),
                                 report.rays, report.count(DiffClass::kGraze));
  if (!report.examples.empty()) text += "; " + describe(scene, question, report.examples.front());
  return text;
}

}  // namespace

std::string show(const std::optional<Hit>& hit) {
  return hit ? fmt::format("primitive {} at t {:a}", hit->primitive, hit->t) : "a miss";
}

std::string show(const Ray& ray) {
  return fmt::format(
      "the ray from ({:a}, {:a}, {:a}) along ({:a}, {:a}, {:a}), t from {:a} to {:a}", ray.origin.x,
      ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z, ray.t_min,
      ray.t_max);
}

std::string HitComparison::same_bits(const Accelerator& structure, const Ray& ray) const {
  const auto expected = exhaustive_.closest_hit(ray);
  const auto found = structure.closest_hit(ray);
  if (found != expected) {
    return fmt::format("{} hits {} first, not {}", show(ray), show(expected), show(found));
  }
  const bool any = structure.any_hit(ray);
  if (any != expected.has_value()) {
    return fmt::format("{} {}, but any_hit says {}", show(ray),
                       expected ? "hits something" : "hits nothing", any);
  }
  return "";
}

std::string HitComparison::single_rays(const Accelerator& structure,
                                       std::span<const Ray> rays) const {
  if (conformance_ != Conformance::kBitExact) return by_the_differ(structure, rays);
  for (const Ray& ray : rays) {
    if (std::string wrong = same_bits(structure, ray); !wrong.empty()) return wrong;
    const auto hit = exhaustive_.closest_hit(ray);
    if (!hit) continue;
    Ray ends_there = ray;
    ends_there.t_max = hit->t;
    Ray begins_there = ray;
    begins_there.t_min = hit->t;
    for (const Ray& cut : {ends_there, begins_there}) {
      if (std::string wrong = same_bits(structure, cut); !wrong.empty()) return wrong;
    }
  }
  return "";
}

std::string HitComparison::by_the_differ(const Accelerator& structure,
                                         std::span<const Ray> rays) const {
  for (const Query query : {Query::kClosestHit, Query::kAnyHit}) {
    const Question question(RaySet{"selftest", query, 0, std::nullopt, {rays.begin(), rays.end()}});
    Answers answers = room_for(question);
    poison(answers);
    ask(structure, question, answers);
    std::string wrong = judged(*scene_, question, answers, conformance_, /*may_graze=*/true);
    if (!wrong.empty()) return wrong;
  }
  return "";
}

std::string HitComparison::image(const Accelerator& structure, const PrimaryRays& rays,
                                 bool may_graze) const {
  const Question question(rays);
  Answers answers = room_for(question);
  poison(answers);
  ask(structure, question, answers);
  if (conformance_ != Conformance::kBitExact) {
    return judged(*scene_, question, answers, conformance_, may_graze);
  }
  const auto& found = std::get<HitBuffer>(answers);
  HitBuffer expected(rays.width(), rays.height(), rays.samples());
  exhaustive_.trace(rays, expected);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (found.t()[i] == expected.t()[i] && found.primitive()[i] == expected.primitive()[i])
      continue;
    return fmt::format("{}: {} hits {} first, not {}", place_text(question, i),
                       show(question.ray(i)), show(expected.get(i)),
                       show(Hit{found.t()[i], found.primitive()[i]}));
  }
  return "";
}

std::size_t HitComparison::count_hits(std::span<const Ray> rays) const {
  std::size_t hits = 0;
  for (const Ray& ray : rays) hits += exhaustive_.any_hit(ray) ? 1 : 0;
  return hits;
}

}  // namespace beambench

#include "harness/verify/selftest/hit_comparison.hpp"

#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "harness/rays/trace_results.hpp"
#include "harness/verify/describe.hpp"
#include "harness/verify/differ.hpp"
#include "harness/verify/selftest/selftest.hpp"
#include "scenes/base/error.hpp"

namespace beambench::verify {
namespace {

rays::TraceInput list_of(std::vector<accel::Ray> rays, rays::Query query) {
  rays::RaySet set;
  set.rays = std::move(rays);
  set.label = "selftest";
  set.query = query;
  return rays::TraceInput(std::move(set));
}

/// Returns the first result that differs from the expected one.
std::optional<Mismatch> first_other(const rays::TraceInput& input, const rays::TraceResults& found,
                                    const rays::TraceResults& expected) {
  const auto mismatch = [&](std::size_t i) {
    Mismatch other{};
    other.index = i;
    other.ray = input.ray(i);
    other.query = input.query();
    other.diff_class = DiffClass::kStructureError;
    other.reason = "other bits than those of exhaustive search, which stand for the oracle's";
    return other;
  };
  if (const auto* any = std::get_if<rays::AnyHits>(&found)) {
    const auto& right = std::get<rays::AnyHits>(expected);
    for (std::size_t i = 0; i < right.size(); ++i) {
      if ((*any)[i] == right[i]) continue;
      Mismatch other = mismatch(i);
      other.any_hit_answer = (*any)[i];
      return other;
    }
    return std::nullopt;
  }
  const auto& hits = std::get<accel::HitBuffer>(found);
  const auto& right = std::get<accel::HitBuffer>(expected);
  for (std::size_t i = 0; i < right.size(); ++i) {
    if (hits.t()[i] == right.t()[i] && hits.primitive()[i] == right.primitive()[i]) continue;
    Mismatch other = mismatch(i);
    other.answer = accel::Hit{hits.t()[i], hits.primitive()[i]};
    if (const auto hit = right.get(i)) other.oracle = {hit->t, hit->primitive};
    return other;
  }
  return std::nullopt;
}

}  // namespace

std::optional<WrongHits> HitComparison::single_rays(const accel::Accelerator& structure,
                                                    std::span<const accel::Ray> rays) const {
  if (conformance_ != accel::Conformance::kBitExact) {
    for (const rays::Query query : {rays::Query::kClosestHit, rays::Query::kAnyHit}) {
      auto wrong = right_by_differ(structure, list_of({rays.begin(), rays.end()}, query),
                                   /*may_graze=*/true);
      if (wrong) return wrong;
    }
    return std::nullopt;
  }
  for (const accel::Ray& ray : rays) {
    if (auto wrong = same_bits(structure, ray)) return wrong;
    const auto hit = exhaustive_.closest_hit(ray, nullptr);
    if (!hit) continue;
    accel::Ray ends_there = ray;
    ends_there.t_max = hit->t;
    accel::Ray begins_there = ray;
    begins_there.t_min = hit->t;
    for (const accel::Ray& cut : {ends_there, begins_there}) {
      if (auto wrong = same_bits(structure, cut)) return wrong;
    }
  }
  return std::nullopt;
}

std::optional<WrongHits> HitComparison::whole(const accel::Accelerator& structure,
                                              const rays::TraceInput& input, bool may_graze) const {
  return conformance_ == accel::Conformance::kBitExact
             ? same_bits(structure, input)
             : right_by_differ(structure, input, may_graze);
}

std::size_t HitComparison::count_hits(std::span<const accel::Ray> rays) const {
  std::size_t hits = 0;
  for (const accel::Ray& ray : rays) hits += exhaustive_.any_hit(ray, nullptr) ? 1 : 0;
  return hits;
}

std::optional<WrongHits> HitComparison::same_bits(const accel::Accelerator& structure,
                                                  const accel::Ray& ray) const {
  const auto expected = exhaustive_.closest_hit(ray, nullptr);
  const auto found = structure.closest_hit(ray, nullptr);
  const bool any = structure.any_hit(ray, nullptr);
  if (found == expected && any == expected.has_value()) return std::nullopt;
  Mismatch wrong{};
  wrong.ray = ray;
  wrong.diff_class = DiffClass::kStructureError;
  wrong.answer = found;
  wrong.any_hit_answer = any ? 1 : 0;
  if (expected) wrong.oracle = {expected->t, expected->primitive};
  if (found != expected) {
    wrong.query = rays::Query::kClosestHit;
    wrong.reason = "not the bits of exhaustive search";
    return WrongHits{
        fmt::format("{} hits {} first, not {}", show(ray), show(expected), show(found)),
        list_of({ray}, wrong.query), wrong};
  }
  wrong.query = rays::Query::kAnyHit;
  wrong.reason = "not what exhaustive search finds";
  return WrongHits{fmt::format("{} {}, but any_hit returns {}", show(ray),
                               expected ? "hits something" : "hits nothing", any),
                   list_of({ray}, wrong.query), wrong};
}

std::optional<WrongHits> HitComparison::same_bits(const accel::Accelerator& structure,
                                                  const rays::TraceInput& input) const {
  const rays::TraceResults found = traced(structure, input);
  const rays::TraceResults expected = traced(exhaustive_, input);
  const auto wrong = first_other(input, found, expected);
  if (!wrong) return std::nullopt;
  const std::size_t i = wrong->index;
  const std::string place = rays::place_text(input, i);
  if (const auto* any = std::get_if<rays::AnyHits>(&found)) {
    return WrongHits{
        fmt::format("{}: {} {}, but its result is {}", place, show(wrong->ray),
                    std::get<rays::AnyHits>(expected)[i] != 0 ? "hits something" : "hits nothing",
                    (*any)[i]),
        input, *wrong};
  }
  return WrongHits{
      fmt::format("{}: {} hits {} first, not {}", place, show(wrong->ray),
                  show(std::get<accel::HitBuffer>(expected).get(i)), show(wrong->answer)),
      input, *wrong};
}

std::optional<WrongHits> HitComparison::right_by_differ(const accel::Accelerator& structure,
                                                        const rays::TraceInput& input,
                                                        bool may_graze) const {
  const DiffReport report =
      verify_results(ReferenceHits(*scene_, input), traced(structure, input), conformance_);
  if (is_right(report.verdict) || (report.verdict == Verdict::kGrazes && may_graze)) {
    return std::nullopt;
  }
  std::string what = fmt::format(
      "the differ's verdict is '{}': {} of {} rays wrong, {} grazes", to_string(report.verdict),
      report.count(DiffClass::kStructureError), report.rays, report.count(DiffClass::kGraze));
  const Mismatch& first = report.examples.front();
  what += "; " + describe(*scene_, input, first);
  return WrongHits{std::move(what), input, first};
}

FindWrong wrong_by_comparison(const accel::StructureChoice& structure) {
  return [structure](const scenes::Scene& scene,
                     const rays::TraceInput& input) -> std::optional<Mismatch> {
    try {
      const auto built = structure.build(scene);
      const auto wrong = HitComparison(scene, structure.info().conformance)
                             .whole(*built, input, /*may_graze=*/true);
      if (wrong) return wrong->first;
    } catch (const InputError&) {  // it refuses this part
    }
    return std::nullopt;
  };
}

}  // namespace beambench::verify

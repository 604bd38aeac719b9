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

/// The part of the rays at edges of a closed mesh that may leak: Embree's robust mode leaks up to
/// 0.1% of them, float arithmetic that is not careful at edges leaks 2% or more.
constexpr double kMaxLeaks = 0.01;

rays::TraceInput list_of(std::vector<accel::Ray> rays, rays::Query query, bool must_hit = false) {
  rays::RaySet set;
  set.rays = std::move(rays);
  set.label = "selftest";
  set.query = query;
  set.must_hit = must_hit;
  return rays::TraceInput(std::move(set));
}

/// Returns how a result differs from that of exhaustive search, which stands for the oracle's.
std::string_view difference(bool found, bool expected) {
  if (!found) return "a hit of exhaustive search was lost";
  return expected ? "not the bits of exhaustive search" : "exhaustive search finds no hit there";
}

/// Returns the first result that differs from the expected one, in the same way as `like` if given.
std::optional<Mismatch> first_other(const rays::TraceInput& input, const rays::TraceResults& found,
                                    const rays::TraceResults& expected,
                                    const Mismatch* like = nullptr) {
  const auto is_like = [&](const Mismatch& other) {
    return like == nullptr || other.reason == like->reason;
  };
  const auto mismatch = [&](std::size_t i, bool is_hit, bool is_expected) {
    Mismatch other{};
    other.index = i;
    other.ray = input.ray(i);
    other.query = input.query();
    other.diff_class = DiffClass::kStructureError;
    other.reason = difference(is_hit, is_expected);
    return other;
  };
  if (const auto* any = std::get_if<rays::AnyHits>(&found)) {
    const auto& right = std::get<rays::AnyHits>(expected);
    for (std::size_t i = 0; i < right.size(); ++i) {
      if ((*any)[i] == right[i]) continue;
      Mismatch other = mismatch(i, (*any)[i] != 0, right[i] != 0);
      other.any_hit_answer = (*any)[i];
      if (is_like(other)) return other;
    }
    return std::nullopt;
  }
  const auto& hits = std::get<accel::HitBuffer>(found);
  const auto& right = std::get<accel::HitBuffer>(expected);
  for (std::size_t i = 0; i < right.size(); ++i) {
    if (hits.t()[i] == right.t()[i] && hits.primitive()[i] == right.primitive()[i]) continue;
    Mismatch other = mismatch(i, hits.get(i).has_value(), right.get(i).has_value());
    const accel::Hit answer{hits.t()[i], hits.primitive()[i]};
    if (answer != accel::Hit{accel::kInfinity, scenes::kNoPrimitive}) other.answer = answer;
    if (const auto hit = right.get(i)) other.oracle = {hit->t, hit->primitive};
    if (is_like(other)) return other;
  }
  return std::nullopt;
}

}  // namespace

std::optional<WrongHits> HitComparison::single_rays(const accel::Accelerator& structure,
                                                    std::span<const accel::Ray> rays,
                                                    bool must_hit) const {
  if (conformance_ != accel::Conformance::kBitExact) {
    for (const rays::Query query : {rays::Query::kClosestHit, rays::Query::kAnyHit}) {
      auto wrong = right_by_differ(structure, list_of({rays.begin(), rays.end()}, query, must_hit),
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
    wrong.reason = difference(found.has_value(), expected.has_value());
    return WrongHits{
        fmt::format("{} hits {} first, not {}", show(ray), show(expected), show(found)),
        list_of({ray}, wrong.query), wrong};
  }
  wrong.query = rays::Query::kAnyHit;
  wrong.reason = difference(any, expected.has_value());
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
  const auto leaks = static_cast<double>(report.leaks);
  if (report.faults() == report.leaks && leaks <= kMaxLeaks * static_cast<double>(report.rays)) {
    return std::nullopt;
  }
  std::string what =
      fmt::format("the differ's verdict is '{}': {} of {} rays wrong, {} leaked, {} grazes",
                  to_string(report.verdict), report.count(DiffClass::kStructureError), report.rays,
                  report.leaks, report.count(DiffClass::kGraze) - report.leaks);
  const Mismatch& first = report.examples.front();
  what += "; " + describe(*scene_, input, first);
  return WrongHits{std::move(what), input, first};
}

FindWrong wrong_by_comparison(const accel::StructureChoice& structure) {
  return [structure](const scenes::Scene& scene, const rays::TraceInput& input,
                     const Mismatch* like) -> std::optional<Mismatch> {
    const accel::Conformance conformance = structure.info().conformance;
    try {
      const rays::TraceResults found = traced(*structure.build(scene), input);
      if (conformance == accel::Conformance::kBitExact) {
        return first_other(input, found, traced(accel::exhaustive::Exhaustive(scene), input), like);
      }
      return first_fault(scene, verify_results(ReferenceHits(scene, input), found, conformance),
                         like);
    } catch (const InputError&) {  // it refuses this part
      return std::nullopt;
    }
  };
}

}  // namespace beambench::verify

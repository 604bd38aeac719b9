#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <span>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "accel/core/inspector_of.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/verify/selftest/hit_comparison.hpp"
#include "harness/verify/selftest/selftest.hpp"
#include "harness/verify/selftest/test_scenes.hpp"

namespace beambench::verify {
namespace {

constexpr int kPrimitives = 40;

using Counts = std::map<std::string, std::uint64_t, std::less<>>;

/// A scene, the structure over it, and rays, some of them short. Their number is not a multiple of
/// a packet's size.
struct Trial {
  Trial(const Subject& subject, std::uint64_t seed)
      : scene(random_scene(seed, kPrimitives, subject.kinds())),
        structure(subject.build(scene)),
        choice(subject.choice()) {
    Random random(seed);
    for (int i = 0; i < 503; ++i) {
      rays.push_back(random_ray(scene, random));
      if (i % 3 == 0) rays.back().t_max = 0.5F * static_cast<float>(i);
    }
  }

  /// Returns an input for every kind of query that the structure supports.
  std::vector<rays::TraceInput> inputs() const {
    std::vector<rays::TraceInput> all{
        rays::TraceInput(rays::RaySet{{rays}, "closest", rays::Query::kClosestHit}),
        rays::TraceInput(rays::RaySet{{rays}, "any", rays::Query::kAnyHit}),
        rays::TraceInput(accel::PrimaryRays(scene.cameras.front(), 37, 23, 5))};
    std::erase_if(all, [this](const auto& input) { return !rays::is_supported(choice, input); });
    return all;
  }
  /// Returns the rays for queries of single rays: none if the structure does not support such
  /// queries.
  std::span<const accel::Ray> single_rays() const {
    if (!choice.info().support.single_rays) return {};
    return rays;
  }

  scenes::Scene scene;
  std::unique_ptr<accel::Accelerator> structure;
  accel::StructureChoice choice;
  std::vector<accel::Ray> rays;
};

std::string first_difference(const rays::TraceResults& a, const rays::TraceResults& b,
                             std::string_view what) {
  if (a == b) return "";
  return fmt::format("{} are not the same", what);
}

/// Returns the first difference, ignoring times, which some families also count and which always
/// differ.
std::string first_difference(const Counts& a, const Counts& b) {
  for (const auto& [name, count] : a) {
    if (name.ends_with("_ns")) continue;
    const auto other = b.find(name);
    if (other == b.end() || other->second != count) {
      return fmt::format("two builds count {} {} and {} for the same rays", count, name,
                         other == b.end() ? 0 : other->second);
    }
  }
  return a.size() == b.size() ? "" : "two builds have different counters";
}

/// Returns an inconsistency in the counters of one ray; empty if there is none.
std::string inconsistency(const accel::Ray& ray, bool hit, const accel::WorkCounters& counters) {
  const auto count = [&](accel::Counter counter) { return counters.get(counter); };
  if (hit && count(accel::Counter::kPrimitiveTests) == 0) {
    return show(ray) + " found a hit without a primitive test counted";
  }
  if (count(accel::Counter::kEmptyLeaves) > count(accel::Counter::kLeaves)) {
    return show(ray) + " entered more empty leaves than leaves";
  }
  if (count(accel::Counter::kLeaves) > count(accel::Counter::kTraversalSteps)) {
    return show(ray) + " entered more leaves than nodes or cells, which include them";
  }
  return "";
}

}  // namespace

rays::TraceResults traced(const accel::Accelerator& structure, const rays::TraceInput& input,
                          accel::WorkCounters* counters) {
  rays::TraceResults results = rays::make_results(input);
  rays::poison(results);
  rays::trace(structure, input, results, counters);
  return results;
}

CheckOutcome check_lists(const Subject& subject, const SelftestEffort& effort) {
  const Trial trial(subject, effort.seed);
  const std::vector<rays::TraceInput> all = trial.inputs();
  if (subject.conformance() == accel::Conformance::kTolerance) {  // lists may round differently
    const HitComparison comparison(trial.scene, subject.conformance());
    for (const rays::TraceInput& list : std::span(all).first(2)) {
      const auto wrong = comparison.whole(*trial.structure, list, false);
      if (wrong) return {trial.rays.size(), wrong->what};
    }
    return {trial.rays.size(), ""};
  }
  const auto closest = std::get<accel::HitBuffer>(traced(*trial.structure, all[0]));
  const auto any = std::get<rays::AnyHits>(traced(*trial.structure, all[1]));
  for (std::size_t i = 0; i < trial.rays.size(); ++i) {
    const accel::Ray& ray = trial.rays[i];
    const accel::Hit written{closest.t()[i], closest.primitive()[i]};
    const auto alone = trial.structure->closest_hit(ray, nullptr);
    if (written != alone.value_or(accel::Hit{accel::kInfinity, scenes::kNoPrimitive})) {
      return {
          trial.rays.size(),
          fmt::format("{} gets {} alone, but t {:a} and primitive {} in a list (a miss is "
                      "infinity and {})",
                      show(ray), show(alone), written.t, written.primitive, scenes::kNoPrimitive)};
    }
    if (any[i] != (trial.structure->any_hit(ray, nullptr) ? 1 : 0)) {
      return {trial.rays.size(),
              fmt::format("any_hit of {} is {} alone, but {} in a list", show(ray),
                          trial.structure->any_hit(ray, nullptr), any[i])};
    }
  }
  return {trial.rays.size(), ""};
}

CheckOutcome check_counting(const Subject& subject, const SelftestEffort& effort) {
  const Trial trial(subject, effort.seed);
  CheckOutcome outcome;
  accel::WorkCounters counters;
  for (const rays::TraceInput& input : trial.inputs()) {
    outcome.rays += input.size();
    outcome.failure = first_difference(traced(*trial.structure, input),
                                       traced(*trial.structure, input, &counters),
                                       "results with and without counting");
    if (!outcome.passed()) return outcome;
  }
  for (const accel::Ray& ray : trial.single_rays()) {
    if (trial.structure->closest_hit(ray, nullptr) !=
            trial.structure->closest_hit(ray, &counters) ||
        trial.structure->any_hit(ray, nullptr) != trial.structure->any_hit(ray, &counters)) {
      outcome.failure = show(ray) + " gets a different result when work is counted";
      return outcome;
    }
  }
  return outcome;
}

CheckOutcome check_two_builds(const Subject& subject, const SelftestEffort& effort) {
  const Trial trial(subject, effort.seed);
  const auto second = subject.build(trial.scene);
  CheckOutcome outcome;
  for (const rays::TraceInput& input : trial.inputs()) {
    outcome.rays += input.size();
    accel::WorkCounters counters_of_first;
    accel::WorkCounters counters_of_second;
    outcome.failure =
        first_difference(traced(*trial.structure, input, &counters_of_first),
                         traced(*second, input, &counters_of_second), "the results of two builds");
    if (outcome.passed()) {
      outcome.failure = first_difference(counters_of_first.by_name(), counters_of_second.by_name());
    }
    if (!outcome.passed()) return outcome;
  }
  const accel::Statistics a = trial.structure->statistics();
  const accel::Statistics b = second->statistics();
  if (a.nodes != b.nodes || a.leaves != b.leaves || a.references != b.references ||
      a.depth != b.depth) {
    outcome.failure = "two builds over one scene differ in nodes, leaves, references or depth";
  }
  return outcome;
}

CheckOutcome check_threads(const Subject& subject, const SelftestEffort& effort) {
  const Trial trial(subject, effort.seed);
  const std::vector<rays::TraceInput> inputs = trial.inputs();
  std::vector<rays::TraceResults> alone;
  std::size_t rays = 0;
  for (const rays::TraceInput& input : inputs) {
    alone.push_back(traced(*trial.structure, input));
    rays += input.size();
  }
  std::array<std::string, 4> wrong;
  {
    std::vector<std::jthread> threads;
    threads.reserve(wrong.size());
    for (std::string& mine : wrong) {
      threads.emplace_back([&] {
        try {
          for (std::size_t i = 0; i < 3 * inputs.size(); ++i) {
            const std::size_t which = i % inputs.size();
            if (traced(*trial.structure, inputs[which]) != alone[which]) {
              mine = "four threads at once get different results than one alone";
            }
          }
        } catch (const std::exception& error) {
          mine = error.what();
        }
      });
    }
  }
  CheckOutcome outcome{wrong.size() * 3 * rays, ""};
  for (const std::string& one : wrong) {
    if (!one.empty()) outcome.failure = one;
  }
  return outcome;
}

CheckOutcome check_counters(const Subject& subject, const SelftestEffort& effort) {
  const Trial trial(subject, effort.seed);
  CheckOutcome outcome;
  accel::WorkCounters all;
  for (const accel::Ray& ray : trial.rays) {
    ++outcome.rays;
    accel::WorkCounters counters;
    const auto hit = trial.structure->closest_hit(ray, &counters);
    all.add(counters);
    if (outcome.passed()) outcome.failure = inconsistency(ray, hit.has_value(), counters);
  }
  // A structure need not count; in that case records have no counters for it.
  const bool counts =
      std::ranges::any_of(all.by_name(), [](const auto& c) { return c.second > 0; });
  return counts ? outcome : CheckOutcome{outcome.rays, ""};
}

CheckOutcome check_statistics(const Subject& subject, const SelftestEffort& effort) {
  const Trial trial(subject, effort.seed);
  const accel::Statistics sizes = trial.structure->statistics();
  const auto wrong = [](std::string what) { return CheckOutcome{0, std::move(what)}; };
  if (sizes.leaves > sizes.nodes)
    return wrong("there are more leaves than nodes, which include them");
  if (sizes.empty_leaves > sizes.leaves) return wrong("there are more empty leaves than leaves");
  if (sizes.depth > sizes.nodes) return wrong("its depth is larger than its number of nodes");
  if (sizes.nodes > 0 && sizes.bytes == 0) return wrong("there are nodes, but they take no memory");
  for (const auto& [name, value] : sizes.more) {
    if (!std::isfinite(value)) return wrong(fmt::format("'{}' is not a number", name));
  }
  return {};
}

CheckOutcome check_explanation(const Subject& subject, const SelftestEffort& effort) {
  const Trial trial(subject, effort.seed);
  CheckOutcome outcome;
  for (const accel::Ray& ray : trial.rays) {
    const std::vector<accel::TraceStep> steps = accel::inspector_of(*trial.structure).path(ray);
    if (steps.empty()) continue;
    ++outcome.rays;
    std::optional<accel::Hit> nearest;
    for (const accel::TraceStep& step : steps) {
      for (const accel::TestedPrimitive& test : step.tests) {
        const accel::Hit hit{test.t, test.primitive};
        if (test.t == test.t && (!nearest || accel::precedes(hit, *nearest))) nearest = hit;
      }
    }
    const auto found = trial.structure->closest_hit(ray, nullptr);
    // A structure that reports no tests explains its traversal, but not its hit.
    if (nearest && nearest != found) {
      outcome.failure = fmt::format("{} is explained to hit {}, but hits {}", show(ray),
                                    show(nearest), show(found));
      return outcome;
    }
  }
  return outcome;
}

}  // namespace beambench::verify

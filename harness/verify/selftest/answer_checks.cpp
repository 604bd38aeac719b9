#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "accel/core/accelerator.hpp"
#include "accel/core/registry.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "harness/verify/describe.hpp"
#include "harness/verify/differ.hpp"
#include "harness/verify/selftest/selftest.hpp"
#include "harness/verify/selftest/test_scenes.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/core/error.hpp"

namespace beambench::verify {
namespace {

/// What the differ finds wrong with the results for an input. Rays that are aimed at edges and
/// corners graze, however many they are.
std::string wrong_by_the_differ(const scenes::Scene& scene, const rays::TraceInput& input,
                                const rays::TraceResults& results, accel::Conformance conformance,
                                bool may_graze) {
  const DiffReport report = verify_results(ReferenceHits(scene, input), results, conformance);
  if (is_right(report.verdict) || (report.verdict == Verdict::kGrazes && may_graze)) return "";
  std::string text = fmt::format(
      "the differ's verdict is '{}': {} of {} rays wrong, {} grazes", to_string(report.verdict),
      report.count(DiffClass::kStructureError), report.rays, report.count(DiffClass::kGraze));
  if (!report.examples.empty()) text += "; " + describe(scene, input, report.examples.front());
  return text;
}

/// The right results over a scene, by what the structure claims: every bit those of exhaustive
/// search, or right by the differ's classes. Each method returns the first wrong answer in a
/// sentence, empty when all are right. The scene outlives it.
class HitComparison {
 public:
  HitComparison(const scenes::Scene& scene, accel::Conformance conformance)
      : scene_(&scene), exhaustive_(scene), conformance_(conformance) {}

  /// Closest and any hits of single rays. Where every bit must be equal, each ray is also traced
  /// with its end, and with its beginning, exactly where it hits.
  std::string single_rays(const accel::Accelerator& structure,
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

  /// The closest hits of an image, as a whole. `may_graze`: more grazes than the differ's budget
  /// are right, as they are where the camera lies on a surface.
  std::string image(const accel::Accelerator& structure, const accel::PrimaryRays& rays,
                    bool may_graze) const {
    const rays::TraceInput input(rays);
    const rays::TraceResults results = traced(structure, input);
    if (conformance_ != accel::Conformance::kBitExact) {
      return wrong_by_the_differ(*scene_, input, results, conformance_, may_graze);
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

  std::size_t count_hits(std::span<const accel::Ray> rays) const {
    std::size_t hits = 0;
    for (const accel::Ray& ray : rays) hits += exhaustive_.any_hit(ray, nullptr) ? 1 : 0;
    return hits;
  }

 private:
  std::string same_bits(const accel::Accelerator& structure, const accel::Ray& ray) const {
    const auto expected = exhaustive_.closest_hit(ray, nullptr);
    const auto found = structure.closest_hit(ray, nullptr);
    if (found != expected) {
      return fmt::format("{} hits {} first, not {}", show(ray), show(expected), show(found));
    }
    const bool any = structure.any_hit(ray, nullptr);
    if (any != expected.has_value()) {
      return fmt::format("{} {}, but any_hit returns {}", show(ray),
                         expected ? "hits something" : "hits nothing", any);
    }
    return "";
  }

  std::string by_the_differ(const accel::Accelerator& structure,
                            std::span<const accel::Ray> rays) const {
    for (const rays::Query query : {rays::Query::kClosestHit, rays::Query::kAnyHit}) {
      const rays::TraceInput input(rays::RaySet{{{rays.begin(), rays.end()}}, "selftest", query});
      const rays::TraceResults results = traced(structure, input);
      std::string wrong =
          wrong_by_the_differ(*scene_, input, results, conformance_, /*may_graze=*/true);
      if (!wrong.empty()) return wrong;
    }
    return "";
  }

  const scenes::Scene* scene_;
  accel::exhaustive::Exhaustive exhaustive_;
  accel::Conformance conformance_;
};

constexpr std::uint64_t kMaxPrimitives = 60;
/// Null where the structure refuses the scene, as it may do with what it cannot do.
std::unique_ptr<accel::Accelerator> build(const accel::StructureChoice& choice,
                                          const scenes::Scene& scene) {
  try {
    return choice.build(scene);
  } catch (const InputError&) {
    return nullptr;
  }
}

/// Adds the outcome of one scene.
void add(CheckOutcome& outcome, std::size_t rays, const std::string& where, std::string wrong) {
  outcome.rays += rays;
  if (!wrong.empty()) outcome.failure = fmt::format("{}: {}", where, wrong);
}

CheckOutcome check_rays(const Subject& subject, const SceneWithRays& made) {
  CheckOutcome outcome;
  const auto structure = subject.build(made.scene);
  add(outcome, made.rays.size(), made.scene.name,
      HitComparison(made.scene, subject.conformance()).single_rays(*structure, made.rays));
  return outcome;
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

CheckOutcome check_random_scenes(const Subject& subject, const SelftestEffort& effort) {
  CheckOutcome outcome;
  std::uint64_t hits = 0;
  std::uint64_t refused = 0;
  for (std::uint64_t i = 0; i < effort.scenes && outcome.passed(); ++i) {
    const std::uint64_t seed = effort.seed + i;
    Random random(seed);
    // Small scenes first: what fails is easy to look at.
    const auto primitives = static_cast<int>(1 + i * kMaxPrimitives / effort.scenes);
    const scenes::Scene scene = random_scene(seed, primitives, subject.kinds());
    const accel::StructureChoice choice = subject.vary(random);
    const auto structure = build(choice, scene);
    if (structure == nullptr) {
      ++refused;
      continue;
    }
    const std::vector<accel::Ray> rays = random_rays(scene, random);
    const HitComparison comparison(scene, subject.conformance());
    hits += comparison.count_hits(rays);
    add(outcome, rays.size(),
        fmt::format("random scene of seed {} with {} primitives, {}", seed, primitives,
                    choice.short_label()),
        comparison.single_rays(*structure, rays));
  }
  if (outcome.passed() && 2 * refused > effort.scenes) {
    outcome.failure = fmt::format("it refused {} of {} scenes", refused, effort.scenes);
  }
  // Rays that all hit or all miss would prove little.
  if (outcome.passed() && effort.scenes >= 40 &&
      (hits < outcome.rays / 5 || hits > outcome.rays * 4 / 5)) {
    outcome.failure =
        fmt::format("{} of {} rays hit: the rays are badly chosen", hits, outcome.rays);
  }
  return outcome;
}

CheckOutcome check_scene_families(const Subject& subject, const SelftestEffort& effort) {
  CheckOutcome outcome;
  for (std::uint64_t i = 0; i < effort.scenes && outcome.passed(); ++i) {
    const std::uint64_t seed = effort.seed + i;
    Random random(seed);
    const scenes::Scene scene = family_scene(seed, subject.kinds());
    const accel::StructureChoice choice = subject.vary(random);
    const auto structure = build(choice, scene);
    if (structure == nullptr) continue;  // check_random_scenes counts these
    const HitComparison comparison(scene, subject.conformance());
    std::vector<accel::Ray> rays = random_rays(scene, random);
    // Embree returns hits that do not lie on the polygon; only exact arithmetic can do better.
    if (subject.conformance() == accel::Conformance::kTolerance) {
      std::erase_if(rays, [&](const accel::Ray& ray) { return is_edge_on(scene, ray); });
    }
    // Below, at and above the width of a register.
    const int width = static_cast<int>(8 + random.below(30));
    const accel::PrimaryRays image(scene.cameras.front(), width, 20, 1);
    const std::string where = fmt::format("{} (scene of the families, seed {}), {}", scene.name,
                                          seed, choice.short_label());
    add(outcome, image.count(), where, comparison.image(*structure, image, /*may_graze=*/true));
    if (outcome.passed()) {
      add(outcome, rays.size(), where, comparison.single_rays(*structure, rays));
    }
  }
  return outcome;
}

CheckOutcome check_images(const Subject& subject, const SelftestEffort& effort) {
  CheckOutcome outcome;
  std::vector<scenes::Scene> scenes;
  for (const char* name : {"tetra:n=3", "balls:n=2", "escena1", "escena2", "bumpy:triangles=768"}) {
    scenes::Scene scene = scenes::load_scene(name);
    if (subject.kinds().include(scene)) scenes.push_back(std::move(scene));
  }
  if (scenes.empty()) scenes.push_back(random_scene(effort.seed, 200, subject.kinds()));
  for (const scenes::Scene& scene : scenes) {
    const auto structure = subject.build(scene);
    for (const int samples : {1, 5}) {
      const accel::PrimaryRays rays(scene.cameras.front(), 41, 33, samples);
      add(outcome, rays.count(), fmt::format("{} with {} samples a pixel", scene.name, samples),
          HitComparison(scene, subject.conformance()).image(*structure, rays, /*may_graze=*/false));
      if (!outcome.passed()) return outcome;
    }
  }
  return outcome;
}

CheckOutcome check_smallest_scenes(const Subject& subject, const SelftestEffort& effort) {
  CheckOutcome outcome;
  for (scenes::Scene& scene : smallest_scenes()) {
    if (!subject.kinds().include(scene)) continue;
    Random random(effort.seed);
    std::vector<accel::Ray> rays{accel::Ray{}};
    if (!scene.primitives.empty()) rays = random_rays(scene, random);
    const CheckOutcome found = check_rays(subject, {std::move(scene), std::move(rays)});
    outcome.rays += found.rays;
    outcome.failure = found.failure;
    if (!outcome.passed()) break;
  }
  return outcome;
}

CheckOutcome check_faces_edges_corners(const Subject& subject, const SelftestEffort&) {
  CheckOutcome cubes = check_rays(subject, cubes_on_a_lattice());
  if (!cubes.passed()) return cubes;
  CheckOutcome block = check_rays(subject, block_of_squares());
  block.rays += cubes.rays;
  return block;
}

CheckOutcome check_heap(const Subject& subject, const SelftestEffort&) {
  return check_rays(subject, heap(subject.kinds()));
}

CheckOutcome check_degenerate_rays(const Subject& subject, const SelftestEffort& effort) {
  scenes::Scene scene = random_scene(effort.seed, 40, subject.kinds());
  std::vector<accel::Ray> rays = degenerate_rays(scene, effort.seed);
  return check_rays(subject, {std::move(scene), std::move(rays)});
}

}  // namespace beambench::verify

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "harness/verify/selftest/checks.hpp"
#include "harness/verify/selftest/hit_comparison.hpp"
#include "harness/verify/selftest/scene_families.hpp"
#include "harness/verify/selftest/test_scenes.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/core/error.hpp"

namespace beambench::verify {
namespace {

constexpr std::uint64_t kMaxPrimitives = 60;
constexpr int kRays = 300;

std::vector<accel::Ray> random_rays(const scenes::Scene& scene, Random& random) {
  std::vector<accel::Ray> rays;
  rays.reserve(kRays);
  for (int i = 0; i < kRays; ++i) rays.push_back(random_ray(scene, random));
  return rays;
}

/// Does the ray lie in the plane of a polygon, as far as float knows? Where it meets that polygon
/// is then decided by rounding alone.
bool is_edge_on(const scenes::Scene& scene, const accel::Ray& ray) {
  constexpr double kMinSine = 1e-5;
  const glm::dvec3 direction(ray.direction);
  return std::ranges::any_of(scene.triangles, [&](const scenes::Triangle& triangle) {
    const glm::dvec3 first(scene.vertices[triangle.vertex[0]]);
    const glm::dvec3 normal = glm::cross(glm::dvec3(scene.vertices[triangle.vertex[1]]) - first,
                                         glm::dvec3(scene.vertices[triangle.vertex[2]]) - first);
    return std::abs(glm::dot(normal, direction)) <=
           kMinSine * glm::length(normal) * glm::length(direction);
  });
}

/// Adds what one scene had to tell to what was found before.
void add(CheckOutcome& outcome, std::size_t rays, const std::string& where, std::string wrong) {
  outcome.rays += rays;
  if (!wrong.empty()) outcome.failure = fmt::format("{}: {}", where, wrong);
}

CheckOutcome ask_about(const Subject& subject, const SceneWithRays& made) {
  CheckOutcome outcome;
  const auto structure = subject.build(made.scene);
  add(outcome, made.rays.size(), made.scene.name,
      HitComparison(made.scene, subject.conformance()).single_rays(*structure, made.rays));
  return outcome;
}

}  // namespace

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
    std::unique_ptr<accel::Accelerator> structure;
    try {
      structure = choice.build(scene);
    } catch (const InputError&) {  // it may refuse what it cannot do, but not everything
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
    std::unique_ptr<accel::Accelerator> structure;
    try {
      structure = choice.build(scene);
    } catch (const InputError&) {  // random scenes ask how much it refuses
      continue;
    }
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
    const CheckOutcome found = ask_about(subject, {std::move(scene), std::move(rays)});
    outcome.rays += found.rays;
    outcome.failure = found.failure;
    if (!outcome.passed()) break;
  }
  return outcome;
}

CheckOutcome check_faces_edges_corners(const Subject& subject, const SelftestEffort&) {
  CheckOutcome cubes = ask_about(subject, cubes_on_a_lattice());
  if (!cubes.passed()) return cubes;
  CheckOutcome block = ask_about(subject, block_of_squares());
  block.rays += cubes.rays;
  return block;
}

CheckOutcome check_heap(const Subject& subject, const SelftestEffort&) {
  return ask_about(subject, heap(subject.kinds()));
}

CheckOutcome check_degenerate_rays(const Subject& subject, const SelftestEffort& effort) {
  scenes::Scene scene = random_scene(effort.seed, 40, subject.kinds());
  std::vector<accel::Ray> rays = degenerate_rays(scene, effort.seed);
  return ask_about(subject, {std::move(scene), std::move(rays)});
}

}  // namespace beambench::verify

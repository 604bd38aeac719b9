#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "accel/core/accelerator.hpp"
#include "accel/core/registry.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/verify/selftest/closed_mesh.hpp"
#include "harness/verify/selftest/hit_comparison.hpp"
#include "harness/verify/selftest/selftest.hpp"
#include "harness/verify/selftest/test_scenes.hpp"
#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::verify {
namespace {

constexpr std::uint64_t kMaxPrimitives = 60;

/// Builds the structure; returns null if it refuses the scene, as it may for unsupported features.
std::unique_ptr<accel::Accelerator> build(const accel::StructureChoice& choice,
                                          const scenes::Scene& scene) {
  try {
    return choice.build(scene);
  } catch (const InputError&) {
    return nullptr;
  }
}

/// Adds the outcome for one scene.
void add(CheckOutcome& outcome, std::size_t rays, const scenes::Scene& scene,
         const accel::StructureChoice& choice, const std::string& where,
         std::optional<WrongHits> wrong) {
  outcome.rays += rays;
  if (!wrong) return;
  outcome.failure = fmt::format("{}: {}", where, wrong->what);
  outcome.failed = FailedInput{scene, choice, std::move(wrong->input), wrong->first};
}

CheckOutcome check_rays(const Subject& subject, const SceneWithRays& made) {
  CheckOutcome outcome;
  const auto structure = subject.build(made.scene);
  add(outcome, made.rays.size(), made.scene, subject.choice(), made.scene.name,
      HitComparison(made.scene, subject.conformance()).single_rays(*structure, made.rays));
  return outcome;
}

/// Leaves out edge-on rays, for which Embree returns hits that do not lie on the polygon; only
/// exact arithmetic can do better.
void leave_out_edge_on(const Subject& subject, const scenes::Scene& scene,
                       std::vector<accel::Ray>& rays) {
  if (subject.conformance() != accel::Conformance::kTolerance) return;
  std::erase_if(rays, [&](const accel::Ray& ray) { return is_edge_on(scene, ray); });
}

/// Returns a scene to be seen by a camera anywhere: random primitives, or a scene of the families.
scenes::Scene scene_to_view(PrimitiveKinds kinds, Random& random) {
  const std::uint64_t seed = random.bits();
  scenes::Scene scene =
      random.below(2) == 0
          ? family_scene(seed, kinds)
          : random_scene(seed, static_cast<int>(1 + random.below(kMaxPrimitives)), kinds);
  add_lights(scene, random);
  return scene;
}

/// Returns an image of about `rays` pixels, with a width below, at or above that of a register.
rays::ImageOfRays image_to_view(const scenes::Scene& scene, std::uint64_t rays, Random& random) {
  const double side = std::sqrt(static_cast<double>(rays));
  const int width = 4 + static_cast<int>(side * random.uniform(0.5, 1.5));
  const int height = 3 + static_cast<int>(static_cast<double>(rays) / width);
  return {random_camera(scene, random), {width, height}, random.below(4) == 0 ? 5 : 1};
}

/// Returns the input without rays in the plane of a polygon, if these prove nothing.
rays::TraceInput worth_tracing(const Subject& subject, const scenes::Scene& scene,
                               rays::TraceInput input) {
  std::vector<accel::Ray> rays;
  for (std::size_t i = 0; i < input.size(); ++i) rays.push_back(input.ray(i));
  leave_out_edge_on(subject, scene, rays);
  if (rays.size() == input.size()) return input;
  rays::RaySet set;
  set.rays = std::move(rays);
  set.label = input.label();
  set.query = input.query();
  return rays::TraceInput(std::move(set));
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
    // Small scenes first, because their failures are easy to examine.
    const auto primitives = static_cast<int>(1 + i * kMaxPrimitives / effort.scenes);
    const scenes::Scene scene = random_scene(seed, primitives, subject.kinds());
    const accel::StructureChoice choice = subject.vary(random);
    const auto structure = build(choice, scene);
    if (structure == nullptr) {
      ++refused;
      continue;
    }
    std::vector<accel::Ray> rays = random_rays(scene, effort.rays, random);
    leave_out_edge_on(subject, scene, rays);
    const HitComparison comparison(scene, subject.conformance());
    hits += comparison.count_hits(rays);
    add(outcome, rays.size(), scene, choice,
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
    std::vector<accel::Ray> rays = random_rays(scene, effort.rays, random);
    leave_out_edge_on(subject, scene, rays);
    // Below, at and above the width of a register.
    const int width = static_cast<int>(8 + random.below(30));
    const accel::PrimaryRays image(scene.cameras.front(), width, 20, 1);
    const std::string where = fmt::format("{} (scene of the families, seed {}), {}", scene.name,
                                          seed, choice.short_label());
    const accel::Support& support = choice.info().support;
    if (support.images) {
      add(outcome, image.count(), scene, choice, where,
          comparison.whole(*structure, image, /*may_graze=*/true));
    }
    if (outcome.passed() && support.single_rays) {
      add(outcome, rays.size(), scene, choice, where, comparison.single_rays(*structure, rays));
    }
  }
  return outcome;
}

CheckOutcome check_views(const Subject& subject, const SelftestEffort& effort) {
  static constexpr std::array kKinds{"primary", "shadow", "mirror", "reflection", "diffuse"};
  CheckOutcome outcome;
  for (std::uint64_t i = 0; i < effort.scenes; ++i) {
    const std::uint64_t seed = effort.seed + i;
    Random random(~seed);  // different numbers from those of the scene
    const scenes::Scene scene = scene_to_view(subject.kinds(), random);
    const accel::StructureChoice choice = subject.vary(random);
    const auto structure = build(choice, scene);
    if (structure == nullptr) continue;  // check_random_scenes counts these
    const rays::ImageOfRays image = image_to_view(scene, effort.rays, random);
    const HitComparison comparison(scene, subject.conformance());
    for (const char* kind : kKinds) {
      try {
        const rays::TraceInput input = worth_tracing(
            subject, scene, rays::make_trace_input(scene, image, rays::parse_ray_choice(kind)));
        if (!rays::is_supported(choice, input)) continue;
        add(outcome, input.size(), scene, choice,
            fmt::format("{} rays over {} (view of seed {}), {}", kind, scene.name, seed,
                        choice.short_label()),
            comparison.whole(*structure, input, /*may_graze=*/true));
      } catch (const rays::NoRaysError&) {  // the camera sees nothing, or no mirror
      }
      if (outcome.passed()) continue;
      if (outcome.failed) outcome.failed->scene.cameras = {image.camera};
      return outcome;
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
      add(outcome, rays.count(), scene, subject.choice(),
          fmt::format("{} with {} samples a pixel", scene.name, samples),
          HitComparison(scene, subject.conformance()).whole(*structure, rays, /*may_graze=*/false));
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
    if (!scene.primitives.empty()) rays = random_rays(scene, effort.rays, random);
    CheckOutcome found = check_rays(subject, {std::move(scene), std::move(rays)});
    found.rays += outcome.rays;
    outcome = std::move(found);
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

CheckOutcome check_closed_meshes(const Subject& subject, const SelftestEffort& effort) {
  CheckOutcome outcome;
  Random random(effort.seed);
  for (const MeshPlace& place : kMeshPlaces) {
    const ClosedMesh mesh = closed_mesh(place.center, place.radius);
    const std::vector<accel::Ray> rays = rays_from_inside(mesh, effort.rays, random);
    const auto structure = subject.build(mesh.scene);
    add(outcome, rays.size(), mesh.scene, subject.choice(),
        fmt::format("{} of radius {}", mesh.scene.name, place.radius),
        HitComparison(mesh.scene, subject.conformance())
            .single_rays(*structure, rays, /*must_hit=*/true));
    if (!outcome.passed()) break;
  }
  return outcome;
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

// tile-beam's hits of pencils, by the differ: shadow rays toward lights anywhere, what planar
// mirrors show, on every instruction set, and closed meshes that leak no light.

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "accel/tile_beam/tile_beam.hpp"
#include "harness/rays/normal.hpp"
#include "harness/rays/ray_generators.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/verify/differ.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/core/random.hpp"
#include "tests/only_target.hpp"
#include "tests/random_scene.hpp"

namespace beambench::verify {
namespace {

using accel::tile_beam::TileBeam;
using glm::dvec3;

struct Outcome {
  DiffReport report;
  DiffReport single;            ///< of the same rays, not marked
  std::uint64_t differing = 0;  ///< rays that hit in one and miss in the other
};

Outcome verified(const scenes::Scene& scene, const rays::TraceInput& input) {
  const TileBeam structure(scene, {});
  rays::TraceResults together = rays::make_results(input);
  rays::poison(together);
  rays::trace(structure, input, together, nullptr);

  rays::RaySet unmarked = *input.list();
  unmarked.pencils.clear();
  const rays::TraceInput single(std::move(unmarked));
  rays::TraceResults alone = rays::make_results(single);
  rays::trace(structure, single, alone, nullptr);

  Outcome outcome;
  const ReferenceHits reference(scene, input);
  outcome.report = verify_results(reference, together, accel::Conformance::kTolerance);
  outcome.single = verify_results(reference, alone, accel::Conformance::kTolerance);
  for (std::size_t i = 0; i < input.size(); ++i) {
    outcome.differing += rays::is_hit_at(together, i) != rays::is_hit_at(alone, i) ? 1U : 0U;
  }
  return outcome;
}

void expect_right(const Outcome& outcome) {
  EXPECT_EQ(outcome.report.count(DiffClass::kStructureError), 0U);
  for (const Mismatch& example : outcome.report.examples) {
    if (example.diff_class != DiffClass::kStructureError) continue;
    ADD_FAILURE() << "ray " << example.index << ": " << example.reason;
    if (example.answer) {
      ADD_FAILURE() << example.answer->primitive << " at " << example.answer->t << ", expected "
                    << (example.exact ? static_cast<int>(example.exact->primitive) : -1) << " at "
                    << (example.exact ? example.exact->t : 0.0);
    }
    break;
  }
  // Whether a ray hits at all is the same as of single rays, except where the differ says graze.
  EXPECT_LE(outcome.differing,
            outcome.report.count(DiffClass::kGraze) + outcome.single.count(DiffClass::kGraze));
}

rays::ImageOfRays image_over(const scenes::Scene& scene, int width, int height, int samples = 1) {
  return rays::image_of(scene.cameras.front(), rays::Resolution{width, height}, samples);
}

void expect_right_over(const scenes::Scene& scene, const rays::ImageOfRays& image,
                       const char* kind) {
  try {
    expect_right(
        verified(scene, rays::make_trace_input(scene, image, rays::parse_ray_choice(kind))));
  } catch (const rays::NoRaysError&) {  // of some random scenes the camera sees nothing
  }
}

/// Anywhere about a scene, on and near its surfaces, in the planes of its faces, on the borders of
/// cells, close to it and far away.
std::vector<scenes::Light> awkward_lights(const scenes::Scene& scene, Random& random) {
  const dvec3 middle = 0.5 * (dvec3(scene.bounds.lower) + dvec3(scene.bounds.upper));
  const double size = glm::length(dvec3(scene.bounds.upper) - dvec3(scene.bounds.lower)) + 1e-3;
  std::vector<scenes::Light> lights;
  const auto add = [&](const dvec3& place) {
    scenes::Light light;
    light.position = glm::vec3(place);
    lights.push_back(light);
  };
  add(middle);
  add(middle + size * point_in_cube(random));
  for (const double distance : {1e-6, 0.01, 5.0, 20.0, 1000.0, 1e6}) {
    add(middle + distance * size * glm::normalize(point_in_cube(random)));
  }
  if (scene.triangles.empty()) return lights;
  const auto corner = [&](const scenes::Triangle& triangle, std::size_t which) {
    return dvec3(scene.vertices[triangle.vertex[which]]);
  };
  for (int i = 0; i < 4; ++i) {
    const scenes::Triangle& triangle =
        scene.triangles[random.below(static_cast<std::uint32_t>(scene.triangles.size()))];
    const dvec3 a = corner(triangle, 0);
    const dvec3 b = corner(triangle, 1);
    const dvec3 c = corner(triangle, 2);
    add(a);
    add((a + b + c) / 3.0);
    add(a + 3.0 * (b - a) + 2.0 * (c - a));
    add((a + b + c) / 3.0 + 1e-5 * size * point_in_cube(random));
  }
  return lights;
}

TEST(PencilHits, OfRandomScenesAndAwkwardLightsAreRight) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    scenes::Scene scene = random_scene(seed, 40);
    scene.lights = awkward_lights(scene, random);
    expect_right_over(scene, image_over(scene, 57, 43, seed % 3 == 0 ? 4 : 1), "shadow");
  }
}

TEST(PencilHits, OfMirrorsInRandomScenesAreRight) {
  for (std::uint64_t seed = 1; seed <= 80; ++seed) {
    SCOPED_TRACE(seed);
    scenes::Scene scene = random_scene(seed, 40);
    for (scenes::Surface& surface : scene.surfaces) surface.specular = 0.5F;
    expect_right_over(scene, image_over(scene, 57, 43, seed % 3 == 0 ? 4 : 1), "mirror");
  }
}

TEST(PencilHits, OfTheCatalogueAreRight) {
  for (const char* name :
       {"tetra:n=4", "tessellated-balls:slices=8", "casa-de-campo", "habitacion", "teapot",
        "bumpy:triangles=20000", "escena1", "balls:n=2", "shells", "finishes", "closed-room"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    expect_right_over(scene, image_over(scene, 160, 120), "shadow");
    expect_right_over(scene, image_over(scene, 160, 120), "mirror");
  }
}

TEST(PencilHits, OfEveryInstructionSetAreRight) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const testing::OnlyTarget only(target);
    for (const char* name : {"casa-de-campo", "balls:n=2", "teapot"}) {
      SCOPED_TRACE(name);
      const scenes::Scene scene = scenes::load_scene(name);
      expect_right_over(scene, image_over(scene, 80, 60), "shadow");
      expect_right_over(scene, image_over(scene, 80, 60), "mirror");
    }
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      SCOPED_TRACE(seed);
      Random random(seed);
      scenes::Scene scene = random_scene(seed, 40);
      scene.lights = awkward_lights(scene, random);
      for (scenes::Surface& surface : scene.surfaces) surface.specular = 0.5F;
      expect_right_over(scene, image_over(scene, 37, 23), "shadow");
      expect_right_over(scene, image_over(scene, 37, 23), "mirror");
    }
  }
}

/// Shadow rays from points all around to a light in a closed mesh, or from points in it to one
/// outside, as a pencil in no order.
TEST(PencilHits, ClosedMeshesLeakNoLight) {
  for (const char* name : {"bumpy:triangles=3072", "bumpy:triangles=48"}) {
    const scenes::Scene scene = scenes::load_scene(name);
    const TileBeam structure(scene, {});
    Random random(5);
    for (int placement = 0; placement < 20; ++placement) {
      // The mesh lies between these spheres about the origin.
      constexpr double kInside = 0.3;
      constexpr double kOutside = 2.0;
      const bool light_inside = placement % 2 == 0;
      const dvec3 direction = glm::normalize(point_in_cube(random));
      const glm::vec3 light(direction *
                            (light_inside ? kInside * random.unit() : kOutside + random.unit()));
      rays::RayList list;
      for (int i = 0; i < 500; ++i) {
        const dvec3 away = glm::normalize(point_in_cube(random));
        accel::Ray ray;
        ray.origin =
            glm::vec3(away * (light_inside ? kOutside + random.unit() : kInside * random.unit()));
        ray.direction = light - ray.origin;
        ray.t_max = 1.0F;
        list.rays.push_back(ray);
      }
      list.pencils.push_back({0, list.rays.size(), dvec3(light), true});
      std::vector<std::uint8_t> hits(list.rays.size(), 9);
      structure.any_hits(list.batch(), hits, nullptr);
      EXPECT_EQ(std::ranges::count(hits, 1), 500) << name << " placement " << placement;
    }
  }
}

TEST(PencilHits, RaysAroundPencilsAreTracedToo) {
  const scenes::Scene scene = scenes::load_scene("casa-de-campo");
  const rays::TraceInput input =
      rays::make_trace_input(scene, image_over(scene, 64, 48), rays::parse_ray_choice("shadow"));
  rays::RaySet some = *input.list();
  ASSERT_GT(some.rays.size(), 400U);
  const dvec3 apex = some.pencils.front().apex;
  some.pencils = {{10, 150, apex, true}, {160, 1, apex, true}, {180, 200, apex, true}};
  expect_right(verified(scene, rays::TraceInput(std::move(some))));
}

TEST(PencilHits, OfRaysWithShorterIntervalsAreRight) {
  const scenes::Scene scene = scenes::load_scene("teapot");
  for (const char* kind : {"shadow", "mirror"}) {
    const rays::TraceInput input =
        rays::make_trace_input(scene, image_over(scene, 96, 72), rays::parse_ray_choice(kind));
    rays::RaySet some = *input.list();
    Random random(3);
    for (accel::Ray& ray : some.rays) {
      if (random.below(3) == 0) ray.t_min = static_cast<float>(random.uniform(0.0, 0.5));
      if (random.below(3) == 0) ray.t_max = static_cast<float>(random.uniform(0.0, 1.0));
    }
    expect_right(verified(scene, rays::TraceInput(std::move(some))));
  }
}

TEST(PencilHits, CountingChangesNoHit) {
  const scenes::Scene scene = scenes::load_scene("teapot");
  const TileBeam structure(scene, {});
  for (const char* kind : {"shadow", "mirror"}) {
    const rays::TraceInput input =
        rays::make_trace_input(scene, image_over(scene, 160, 120), rays::parse_ray_choice(kind));
    rays::TraceResults timed = rays::make_results(input);
    rays::TraceResults counted = rays::make_results(input);
    accel::WorkCounters counters;
    rays::trace(structure, input, timed, nullptr);
    rays::trace(structure, input, counted, &counters);
    EXPECT_EQ(timed, counted);
    EXPECT_GT(counters.get(accel::Counter::kTraversalSteps), 0U);
    EXPECT_LT(counters.get(accel::Counter::kTraversalSteps), input.size());
  }
}

}  // namespace
}  // namespace beambench::verify

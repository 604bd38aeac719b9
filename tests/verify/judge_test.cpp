// The judge in situations where it was once wrong: ends of rays on surfaces, huge floors next to
// small objects, crossings behind grazed ones, short directions. Then all structures over random
// scenes; BEAMBENCH_JUDGE_SCENES=N in the environment sets their number.

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/verify/differ.hpp"
#include "scenes/base/error.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/number_from.hpp"
#include "tests/random_scene.hpp"
#include "tests/verify/exact_answers.hpp"
#include "tests/verify/first_example.hpp"

namespace beambench::verify {
namespace {

using accel::Hit;
using accel::Ray;
using glm::dvec3;

constexpr const char* kExactStructures[] = {"exhaustive",       "samet",   "voxel-grid",
                                            "goldsmith-salmon", "sah-bvh", "kd-tree"};

void add_rectangle(scenes::SceneBuilder& builder, const dvec3& corner, const dvec3& side,
                   const dvec3& other) {
  const dvec3 corners[] = {corner, corner + side, corner + side + other, corner + other};
  builder.add_polygon(corners);
}
/// Adds a square in a plane of constant y.
void add_level(scenes::SceneBuilder& builder, double y, double half) {
  add_rectangle(builder, {-half, y, -half}, {2.0 * half, 0.0, 0.0}, {0.0, 0.0, 2.0 * half});
}

scenes::Camera looking(const glm::vec3& from, const glm::vec3& at) {
  scenes::Camera camera;
  camera.from = from;
  camera.at = at;
  camera.up = {0.0F, 1.0F, 0.0F};
  camera.angle = 60.0F;
  return camera;
}

rays::TraceInput made_rays(const scenes::Scene& scene, std::string_view kind, int size) {
  return rays::make_trace_input(scene, {scene.cameras.front(), {size, size}, 1},
                                rays::parse_ray_choice(kind));
}

rays::TraceResults results_of(const scenes::Scene& scene, const rays::TraceInput& input,
                              const std::string& structure) {
  rays::TraceResults results = rays::make_results(input);
  rays::trace(*accel::registry().choose(parse_spec(structure)).build(scene), input, results,
              nullptr);
  return results;
}

DiffReport report_of(const scenes::Scene& scene, const rays::TraceInput& input,
                     const rays::TraceResults& results) {
  return verify_results(ReferenceHits(scene, input), results, accel::Conformance::kTolerance);
}

void expect_right(const scenes::Scene& scene, const rays::TraceInput& input,
                  std::initializer_list<const char*> structures, std::uint64_t grazes = 0) {
  const ReferenceHits reference(scene, input);
  for (const char* structure : structures) {
    SCOPED_TRACE(structure);
    const DiffReport report = verify_results(reference, results_of(scene, input, structure),
                                             accel::Conformance::kTolerance);
    EXPECT_EQ(report.verdict, Verdict::kOk) << tests::first_example(reference, report);
    EXPECT_LE(report.count(DiffClass::kGraze), grazes) << tests::first_example(reference, report);
  }
}

/// Returns a floor and a ceiling, with a light exactly in the ceiling.
scenes::Scene room_lit_from_its_ceiling(bool with_sphere) {
  scenes::SceneBuilder builder("room");
  add_level(builder, 0.0, 2.0);
  add_level(builder, 1.1, 2.0);
  if (with_sphere) builder.add_sphere({0.3, 0.3, 0.2}, 0.25);
  builder.add_light({0.123, 1.1, 0.077});
  builder.add_camera(looking({0.0F, 0.7F, 1.9F}, {0.0F, 0.2F, 0.0F}));
  return std::move(builder).build();
}

TEST(EndsOfRays, ALightOnASurfaceShines) {
  const scenes::Scene empty = room_lit_from_its_ceiling(false);
  const rays::TraceInput rays = made_rays(empty, "shadow", 65);
  ASSERT_GT(rays.size(), 1000U);
  const auto answers = std::get<rays::AnyHits>(results_of(empty, rays, "exhaustive"));
  EXPECT_EQ(std::ranges::count(answers, 1), 0);
  expect_right(empty, rays, {"exhaustive", "samet", "kd-tree", "sah-bvh", "embree", "tile-beam"});
}

TEST(EndsOfRays, StructuresAreCorrectForALightOnASurface) {
  const scenes::Scene scene = room_lit_from_its_ceiling(true);
  const rays::TraceInput rays = made_rays(scene, "shadow", 65);
  const auto answers = std::get<rays::AnyHits>(results_of(scene, rays, "exhaustive"));
  EXPECT_GT(std::ranges::count(answers, 1), 10);
  expect_right(scene, rays, {"exhaustive", "samet", "kd-tree", "sah-bvh"});
  expect_right(scene, rays, {"embree", "tile-beam"}, 2);
}

// t_max is the float of the ray's own t, and the interval is closed.
TEST(EndsOfRays, ARayThatEndsAtItsOwnHitHasIt) {
  std::uint64_t ended = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const scenes::Scene scene = tests::random_scene(seed, 30);
    Random random(seed);
    rays::RaySet set;
    for (int i = 0; i < 40; ++i) {
      Ray ray = tests::random_ray(scene, random);
      const auto hit = tests::exact_closest_hit(scene, ray);
      if (!hit) continue;
      ray.t_max = static_cast<float>(hit->t);
      set.rays.push_back(ray);
    }
    ended += set.rays.size();
    const rays::TraceInput closest(set);
    expect_right(scene, closest, {"exhaustive", "sah-bvh"}, 2);  // many are aimed at corners
    set.query = rays::Query::kAnyHit;
    const rays::TraceInput any(set);
    expect_right(scene, any, {"exhaustive", "sah-bvh"}, 2);
  }
  EXPECT_GT(ended, 500U);
}

TEST(EndsOfRays, HitsAtTheStartCount) {
  scenes::SceneBuilder builder("corner");
  scenes::Surface shiny;
  shiny.specular = 0.5F;
  builder.set_surface(shiny);
  add_level(builder, 0.0, 3.0);
  add_rectangle(builder, {0.0, -1.0, -3.0}, {0.0, 0.0, 6.0}, {0.0, 3.0, 0.0});
  builder.add_camera(looking({0.0F, 1.0F, 2.5F}, {0.0F, 0.0F, 0.0F}));  // in the wall
  const scenes::Scene scene = std::move(builder).build();
  for (const char* kind : {"primary", "diffuse", "path"}) {
    SCOPED_TRACE(kind);
    expect_right(scene, made_rays(scene, kind, 129), {"exhaustive", "samet", "kd-tree", "sah-bvh"});
  }
}

TEST(EndsOfRays, AnEyeOnASphereSeesItOrLooksAway) {
  scenes::SceneBuilder builder("ball");
  builder.add_sphere({0.1, 0.2, 0.3}, 0.7);
  builder.add_camera(looking({0.1F, 0.2F, 1.0F}, {5.0F, 0.3F, 0.9F}));
  const scenes::Scene scene = std::move(builder).build();
  expect_right(scene, made_rays(scene, "primary", 33), {"exhaustive", "samet", "sah-bvh"});
}

/// Returns the class of a closest-hit claim, judged alone.
DiffClass judged(const scenes::Scene& scene, const Ray& ray, const std::optional<Hit>& claim) {
  rays::RaySet set;
  set.rays = {ray};
  const rays::TraceInput input(std::move(set));
  rays::TraceResults results = rays::make_results(input);
  std::get<accel::HitBuffer>(results).set(0, claim);
  std::vector<DiffClass> classes(1);
  verify_results(ReferenceHits(scene, input), results, accel::Conformance::kTolerance, classes);
  return classes.front();
}
bool accepts(const scenes::Scene& scene, const Ray& ray, const std::optional<Hit>& claim) {
  return judged(scene, ray, claim) != DiffClass::kStructureError;
}

TEST(Ties, AreNotFarBehindTheNearerSurface) {
  for (const double size : {10.0, 1000.0, 1e6}) {
    SCOPED_TRACE(size);
    scenes::SceneBuilder builder("upright");
    add_level(builder, 0.0, size);
    const dvec3 triangle[] = {{0.0, -1.0, -1.0}, {0.0, 3.0, 0.0}, {0.0, -1.0, 1.0}};
    builder.add_polygon(triangle);
    const scenes::Scene scene = std::move(builder).build();
    const Ray ray{{5.0F, 5e-4F, 0.1F}, 0.0F, {-1.0F, -1e-6F, 0.0F}};
    EXPECT_EQ(judged(scene, ray, Hit{5.0F, 1}), DiffClass::kAgree);
    EXPECT_FALSE(accepts(scene, ray, Hit{500.0F, 0}));
    EXPECT_FALSE(accepts(scene, ray, Hit{7.0F, 0}));
  }
}

// The reverse case: an object behind a floor that the ray enters at grazing incidence.
TEST(Ties, AreNotFarBehindAGrazingSurfaceEither) {
  scenes::SceneBuilder builder("sinking");
  const dvec3 floor[] = {{-900.0, 0.0, -900.0}, {900.0, 0.0, -900.0}, {0.0, 0.0, 900.0}};
  builder.add_polygon(floor);
  add_rectangle(builder, {-4.0, -1.0, -1.0}, {0.0, 2.0, 0.0}, {0.0, 0.0, 2.0});
  const scenes::Scene scene = std::move(builder).build();
  const Ray ray{{1.0F, 1e-6F, 0.1F}, 0.0F, {-1.0F, -1e-6F, 0.0F}};
  EXPECT_TRUE(accepts(scene, ray, Hit{1.0F, 0}));
  EXPECT_FALSE(accepts(scene, ray, Hit{5.0F, 1}));  // 4 behind, though 4e-6 below the floor
}

TEST(Tolerances, AreNotThoseOfAHugeFloor) {
  scenes::SceneBuilder builder("plain");
  add_level(builder, 0.0, 1e6);
  for (int i = 0; i < 9; ++i) builder.add_sphere({i % 3 - 1.0, 0.45, i / 3 - 1.0}, 0.45);
  builder.add_light({2.0, 5.0, 3.0});
  builder.add_camera(looking({0.0F, 3.0F, 4.0F}, {0.0F, 0.0F, 0.0F}));
  const scenes::Scene scene = std::move(builder).build();
  scenes::SceneBuilder floor_builder("floor");
  add_level(floor_builder, 0.0, 1e6);
  floor_builder.add_camera(scene.cameras.front());
  const scenes::Scene floor = std::move(floor_builder).build();

  const rays::TraceInput primary = made_rays(scene, "primary", 65);
  const DiffReport report = report_of(scene, primary, results_of(floor, primary, "exhaustive"));
  EXPECT_EQ(report.verdict, Verdict::kMismatch);
  EXPECT_LE(report.count(DiffClass::kTie), 2U);
  EXPECT_GT(report.count(DiffClass::kStructureError), 500U);

  const rays::TraceInput shadow = made_rays(scene, "shadow", 65);
  EXPECT_GT(shadow.size(), 2000U);
  for (const char* structure : kExactStructures) {
    expect_right(scene, primary, {structure});
    expect_right(scene, shadow, {structure});
  }
}

TEST(Grazes, DoNotExcuseHitsBehindThem) {
  scenes::SceneBuilder builder("three");
  const dvec3 triangle[] = {{0.0, -1.0, 2.0}, {1.0, 0.0, 2.0}, {0.0, 1.0, 2.0}};
  builder.add_polygon(triangle);
  add_rectangle(builder, {-3.0, -3.0, 1.0}, {6.0, 0.0, 0.0}, {0.0, 6.0, 0.0});
  add_rectangle(builder, {-3.0, -3.0, 0.0}, {6.0, 0.0, 0.0}, {0.0, 6.0, 0.0});
  const scenes::Scene scene = std::move(builder).build();
  for (const float beside : {1e-7F, 0.0F, -1e-7F}) {  // the triangle's edge
    SCOPED_TRACE(beside);
    const Ray ray{{beside, 0.25F, 5.0F}};
    EXPECT_TRUE(accepts(scene, ray, Hit{3.0F, 0}));
    EXPECT_TRUE(accepts(scene, ray, Hit{4.0F, 1}));
    EXPECT_FALSE(accepts(scene, ray, Hit{5.0F, 2}));
    EXPECT_FALSE(accepts(scene, ray, std::nullopt));
  }
}

/// Returns twenty triangles, one behind another, which all rays of the tests cross.
scenes::Scene stack_of_triangles() {
  scenes::SceneBuilder builder("stack");
  for (int i = 0; i < 20; ++i) {
    const double z = -0.05 * i;
    const dvec3 corners[] = {{0.0, 0.0, z}, {1.0, 0.0, z}, {0.0, 1.0, z}};
    builder.add_polygon(corners);
  }
  return std::move(builder).build();
}

TEST(ShortAndLongDirections, AreJudgedEqually) {
  const scenes::Scene scene = stack_of_triangles();
  for (int exponent = -99; exponent <= 29; ++exponent) {
    SCOPED_TRACE(exponent);
    const float scale = std::ldexp(1.0F, exponent);
    const Ray ray{{0.2F, 0.2F, 1.0F}, 0.0F, scale * glm::vec3(0.1F, 0.1F, -1.0F)};
    const float t = 1.0F / scale;
    EXPECT_EQ(judged(scene, ray, Hit{t, 0}), DiffClass::kAgree);
    EXPECT_FALSE(accepts(scene, ray, std::nullopt));
    EXPECT_FALSE(accepts(scene, ray, Hit{1.05F * t, 1}));
    Ray beyond = ray;
    beyond.t_min = 1.5F * t;
    EXPECT_EQ(judged(scene, beyond, Hit{1.5F * t, 10}), DiffClass::kAgree);
    EXPECT_FALSE(accepts(scene, beyond, std::nullopt));
    Ray before = ray;
    before.t_max = 0.5F * t;
    EXPECT_EQ(judged(scene, before, std::nullopt), DiffClass::kAgree);
    rays::RaySet set;
    set.rays = {ray};
    set.query = rays::Query::kAnyHit;
    const rays::TraceInput any(std::move(set));
    EXPECT_EQ(report_of(scene, any, rays::AnyHits{1}).verdict, Verdict::kOk);
    EXPECT_EQ(report_of(scene, any, rays::AnyHits{0}).verdict, Verdict::kMismatch);
  }
}

// Embree flushes subnormals during its builds, and parallel loops inherit that mode from a thread
// whose first loop was Embree's. The judge's loops must not.
TEST(ShortAndLongDirections, DenormalComponentsCount) {
  scenes::SceneBuilder builder("ceiling");
  add_level(builder, 1.5, 3.0);
  const scenes::Scene scene = std::move(builder).build();
  rays::RaySet set;
  set.rays = {{{1.0F, 1.5F, 2.0F}, 0.0F, {-2e-24F, 4e-44F, -2e-24F}, 0.0F}};  // not in the plane
  set.query = rays::Query::kAnyHit;
  const rays::TraceInput input(std::move(set));
  std::thread([&] {  // has not run a parallel loop yet
    EXPECT_EQ(report_of(scene, input, rays::AnyHits{1}).verdict, Verdict::kOk);
  })
      .join();
}

// The ray passes within K u of an edge, but ends just before it. The grazing incidence (0.0064)
// stretches distances along the ray. Embree's fast kernels report a hit.
TEST(ShadowRays, MayEndAtTheEdgeOfAGrazedTriangle) {
  scenes::SceneBuilder builder("light on a triangle");
  const std::vector<glm::vec3> corners{{0.74624324F, -0.4514901F, -0.55538934F},
                                       {0.6549004F, -0.49453083F, -0.34204808F},
                                       {0.6363369F, -0.22555444F, -0.68356264F}};
  builder.add_polygon(std::vector<glm::dvec3>(corners.begin(), corners.end()));
  const scenes::Scene scene = std::move(builder).build();
  const auto verdict = [&](float t_max) {
    rays::RaySet set;
    set.query = rays::Query::kAnyHit;
    set.rays = {{{-0.14777419F, 0.7133988F, -0.642779F},
                 0.0F,
                 {0.848346F, -1.1864092F, 0.19406027F},
                 t_max}};
    return report_of(scene, rays::TraceInput(std::move(set)), rays::AnyHits{1}).verdict;
  };
  EXPECT_EQ(verdict(0.99999565F), Verdict::kOk);
  EXPECT_EQ(verdict(0.999F), Verdict::kMismatch);
}

// A t that is too large for float is not a hit, whatever t_max is.
TEST(ShortAndLongDirections, HitsBeyondTheLargestFloatAreMisses) {
  scenes::SceneBuilder builder("far");
  add_rectangle(builder, {-1e9, -1e9, -1e9}, {2e9, 0.0, 0.0}, {0.0, 2e9, 0.0});
  const scenes::Scene scene = std::move(builder).build();
  const Ray near{{2e8F, 1e8F, 0.0F}, 0.0F, {0.0F, 0.0F, -4e-30F}};
  const Ray far{{2e8F, 1e8F, 0.0F}, 0.0F, {0.0F, 0.0F, -2e-30F}};
  EXPECT_TRUE(accepts(scene, near, Hit{2.5e38F, 0}));
  EXPECT_FALSE(accepts(scene, near, std::nullopt));
  EXPECT_TRUE(accepts(scene, far, std::nullopt));
  EXPECT_FALSE(accepts(scene, far, Hit{std::numeric_limits<float>::max(), 0}));
  EXPECT_FALSE(accepts(scene, far, Hit{accel::kInfinity, 0}));
  rays::RaySet set;
  set.rays = {near, far};
  const rays::TraceInput input(std::move(set));
  expect_right(scene, input, {"exhaustive", "samet", "sah-bvh", "kd-tree"});
}

// An exact hit that the oracle misses is correct, and not a graze.
TEST(Disputes, ExactAnswersAreNeverGrazes) {
  const scenes::Scene scene = stack_of_triangles();
  rays::RaySet set;
  for (int i = 0; i <= 16; ++i) {  // along an edge of all triangles
    set.rays.push_back({{0.0F, static_cast<float>(i) / 16.0F, 1.0F}});
  }
  const rays::TraceInput input(std::move(set));
  const rays::TraceResults hits = results_of(scene, input, "exhaustive");
  const std::vector<std::optional<accel::oracle::ExactHit>> none(input.size());
  const DiffReport report =
      verify_results(ReferenceHits(scene, input, none), hits, accel::Conformance::kTolerance);
  EXPECT_EQ(report.count(DiffClass::kAgree), input.size());
}

/// Returns lights on, in and just off the surfaces of random scenes.
scenes::Scene with_lights_at_surfaces(std::uint64_t seed) {
  const scenes::Scene plain = tests::random_scene(seed, 25);
  const rays::TraceInput image(accel::PrimaryRays(plain.cameras.front(), 5, 5, 1));
  scenes::Scene lit = plain;
  Random random(seed);
  for (std::size_t i = 0; i < image.size() && lit.lights.size() < 4; ++i) {
    const Ray ray = image.ray(i);
    const auto hit = tests::exact_closest_hit(plain, ray);
    if (!hit) continue;
    const double moved = random.below(3) == 0 ? 0.0 : random.uniform(-1e-4, 1e-4);
    const dvec3 at = dvec3(ray.origin) + (hit->t + moved) * dvec3(ray.direction);
    lit.lights.push_back({glm::vec3(at), glm::vec3(1.0F)});
  }
  return lit;
}

TEST(RandomScenes, StructuresAreCorrectWithLightsAtSurfaces) {
  const std::uint64_t scenes = tests::number_from("BEAMBENCH_JUDGE_SCENES", 150);
  std::uint64_t rays = 0;
  for (std::uint64_t seed = 0; seed < scenes && !HasFailure(); ++seed) {
    const scenes::Scene scene = with_lights_at_surfaces(seed);
    if (scene.lights.empty()) continue;
    for (const char* kind : {"shadow", "diffuse"}) {
      const rays::TraceInput input = made_rays(scene, kind, 24);
      rays += input.size();
      const ReferenceHits reference(scene, input);
      for (const accel::StructureInfo& structure : accel::registry().structures()) {
        if (structure.conformance == accel::Conformance::kBaseline) continue;
        if (!structure.support.batches) continue;
        SCOPED_TRACE(fmt::format("{}, seed {}, {}", structure.name, seed, kind));
        const DiffReport report = verify_results(
            reference, results_of(scene, input, structure.name), accel::Conformance::kTolerance);
        EXPECT_EQ(report.count(DiffClass::kStructureError), 0U)
            << tests::first_example(reference, report);
        if (structure.name == "exhaustive") {
          EXPECT_EQ(report.verdict, Verdict::kOk) << tests::first_example(reference, report);
        }
      }
    }
  }
  EXPECT_GT(rays, 150 * scenes);
}

}  // namespace
}  // namespace beambench::verify

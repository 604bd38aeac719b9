// tile-beam's hits of pencils, checked by the differ: shadow rays toward lights anywhere, and
// reflections in planar mirrors, on every instruction set and on several threads.

#include <algorithm>
#include <cmath>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "accel/core/tolerance.hpp"
#include "accel/octree/octree.hpp"
#include "accel/tile_beam/tile_beam.hpp"
#include "harness/rays/normal.hpp"
#include "harness/rays/ray_generators.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/verify/differ.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/only_target.hpp"
#include "tests/random_scene.hpp"

namespace beambench::verify {
namespace {

using accel::tile_beam::TileBeam;
using glm::dvec3;
using tests::random_direction;

struct Outcome {
  DiffReport report;
  DiffReport single;            ///< of the same rays, unmarked
  std::uint64_t differing = 0;  ///< rays that hit in one and miss in the other
  std::uint64_t beams = 0;      ///< parts of pencils that were traced together
};

Outcome verified(const scenes::Scene& scene, const rays::TraceInput& input,
                 const accel::tile_beam::TileHierarchyOptions& options = {}) {
  const TileBeam structure(scene, options);
  rays::TraceResults together = rays::make_results(input);
  rays::poison(together);
  rays::trace(structure, input, together, nullptr);
  rays::TraceResults counted = rays::make_results(input);
  accel::WorkCounters counters;
  rays::trace(structure, input, counted, &counters);

  rays::RaySet unmarked = *input.list();
  unmarked.pencils.clear();
  const rays::TraceInput single(std::move(unmarked));
  rays::TraceResults alone = rays::make_results(single);
  rays::trace(structure, single, alone, nullptr);

  Outcome outcome;
  outcome.beams = counters.by_name()["beams"];
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
  // Hits and misses are the same as for single rays, except where the differ reports a graze.
  EXPECT_LE(outcome.differing,
            outcome.report.count(DiffClass::kGraze) + outcome.single.count(DiffClass::kGraze));
}

rays::ImageOfRays image_over(const scenes::Scene& scene, int width, int height, int samples = 1) {
  return rays::image_of(scene.cameras.front(), rays::Resolution{width, height}, samples);
}

/// Expects correct hits for one kind of rays. Returns the number of parts of pencils, which shows
/// whether there were enough rays for pencils.
std::uint64_t expect_right_over(const scenes::Scene& scene, const rays::ImageOfRays& image,
                                const char* kind) {
  try {
    const Outcome outcome =
        verified(scene, rays::make_trace_input(scene, image, rays::parse_ray_choice(kind)));
    expect_right(outcome);
    return outcome.beams;
  } catch (const rays::NoRaysError&) {  // in some random scenes the camera sees nothing
    return 0;
  }
}

scenes::Light light_at(const dvec3& place) {
  scenes::Light light;
  light.position = glm::vec3(place);
  return light;
}

double size_of(const scenes::Scene& scene) {
  return glm::length(dvec3(scene.bounds.upper) - dvec3(scene.bounds.lower)) + 1e-3;
}

/// Returns lights anywhere around a scene: on and near its surfaces, in the planes of its faces,
/// close to it and far away.
std::vector<scenes::Light> awkward_lights(const scenes::Scene& scene, Random& random) {
  const dvec3 middle = 0.5 * (dvec3(scene.bounds.lower) + dvec3(scene.bounds.upper));
  const double size = size_of(scene);
  std::vector<scenes::Light> lights;
  const auto add = [&](const dvec3& place) { lights.push_back(light_at(place)); };
  add(middle);
  add(middle + size * point_in_cube(random));
  for (const double distance : {1e-6, 0.01, 5.0, 20.0, 1000.0, 1e6}) {
    add(middle + distance * size * random_direction(random));
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

TEST(PencilHits, OfRandomScenesAndDifficultLightsAreCorrect) {
  std::uint64_t beams = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    scenes::Scene scene = random_scene(seed, 40);
    scene.lights = awkward_lights(scene, random);
    beams += expect_right_over(scene, image_over(scene, 96, 72, seed % 3 == 0 ? 4 : 1), "shadow");
  }
  EXPECT_GT(beams, 1500U);
}

/// Uses balls of light that touch surfaces, enclose objects and lie inside solids.
TEST(PencilHits, OfAreaLightsAreCorrect) {
  std::uint64_t beams = 0;
  for (std::uint64_t seed = 200; seed < 224; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    scenes::Scene scene = random_scene(seed, 40);
    scene.lights = awkward_lights(scene, random);
    for (const char* rays : {"area:samples=5,size=0.02", "area:samples=3,size=1"}) {
      beams += expect_right_over(scene, image_over(scene, 80, 60), rays);
    }
  }
  EXPECT_GT(beams, 1500U);
}

/// Returns lights at distances of every power of ten from 1e-6 to 1e6 scene sizes, measured from
/// the scene's center, from both sides of a triangle, and from a sphere and a cone, inside and
/// outside.
std::vector<scenes::Light> lights_at_every_distance(const scenes::Scene& scene, Random& random) {
  const dvec3 middle = 0.5 * (dvec3(scene.bounds.lower) + dvec3(scene.bounds.upper));
  std::vector<scenes::Light> lights;
  for (int exponent = -6; exponent <= 6; ++exponent) {
    const double distance = std::pow(10.0, exponent) * size_of(scene);
    const auto add_both = [&](const dvec3& point, const dvec3& normal) {
      lights.push_back(light_at(point + distance * normal));
      lights.push_back(light_at(point - distance * normal));
    };
    lights.push_back(light_at(middle + distance * random_direction(random)));
    if (!scene.triangles.empty()) {
      const scenes::Triangle& triangle = scene.triangles[random.below(scene.triangles.size())];
      const dvec3 a(scene.vertices[triangle.vertex[0]]);
      const dvec3 b(scene.vertices[triangle.vertex[1]]);
      const dvec3 c(scene.vertices[triangle.vertex[2]]);
      add_both((a + b + c) / 3.0, glm::normalize(glm::cross(b - a, c - a)));
    }
    if (!scene.spheres.empty()) {
      const scenes::Sphere& sphere = scene.spheres[random.below(scene.spheres.size())];
      const dvec3 normal = random_direction(random);
      add_both(dvec3(sphere.center) + double{sphere.radius} * normal, normal);
    }
    if (!scene.cones.empty()) {
      const scenes::Cone& cone = scene.cones[random.below(scene.cones.size())];
      const dvec3 axis = glm::normalize(dvec3(cone.apex) - dvec3(cone.base));
      const dvec3 normal = glm::normalize(glm::cross(axis, random_direction(random)));
      add_both(0.5 * (dvec3(cone.base) + dvec3(cone.apex)) +
                   0.5 * (double{cone.base_radius} + cone.apex_radius) * normal,
               normal);
    }
  }
  return lights;
}

/// Returns whether the seed's scene has coordinates much larger than its size, as one in four does.
bool is_remote(std::uint64_t seed) { return seed % 4 == 2; }

TEST(PencilHits, OfLightsAtEveryDistanceAreCorrect) {
  std::uint64_t beams = 0;
  std::size_t most_lights = 0;
  for (std::uint64_t seed = 100; seed < 124; ++seed) {
    if (is_remote(seed)) continue;
    SCOPED_TRACE(seed);
    Random random(seed);
    scenes::Scene scene = random_scene(seed, 30);
    scene.lights = lights_at_every_distance(scene, random);
    most_lights = std::max(most_lights, scene.lights.size());
    beams += expect_right_over(scene, image_over(scene, 120, 90), "shadow");
  }
  EXPECT_GE(most_lights, 64U);  // many pencils in one list
  EXPECT_GT(beams, 2000U);
}

TEST(PencilHits, OfLightsAtEveryDistanceFromRemoteScenesAreCorrect) {
  std::uint64_t beams = 0;
  for (std::uint64_t seed = 102; seed < 302; seed += 4) {
    ASSERT_TRUE(is_remote(seed));
    SCOPED_TRACE(seed);
    Random random(seed);
    scenes::Scene scene = random_scene(seed, 30);
    scene.lights = lights_at_every_distance(scene, random);
    for (const double coordinates : {3.0, 6.0, 10.0, 14.0, 19.0}) {
      scene.lights.push_back(
          light_at(coordinates * scene.bounds.largest_coordinate() * random_direction(random)));
    }
    beams += expect_right_over(scene, image_over(scene, 120, 90), "shadow");
  }
  EXPECT_GT(beams, 2000U);
}

/// Returns blades of grass in front of the camera, on four kilometers of ground under an equally
/// distant light.
scenes::Scene grass(std::uint64_t seed) {
  scenes::SceneBuilder builder("grass");
  const auto ground = [](double x, double z) { return dvec3(x, 0.0, z); };
  builder.add_polygon(std::vector<dvec3>{ground(-2e3, -2e3), ground(2e3, -2e3), ground(2e3, 2e3),
                                         ground(-2e3, 2e3)});
  Random random(seed);
  for (int i = 0; i < 6000; ++i) {
    const dvec3 root{random.uniform(-4.0, 4.0), 0.0, random.uniform(2.0, 12.0)};
    const dvec3 tip = root + dvec3{random.uniform(-0.1, 0.1), random.uniform(0.2, 0.6), 0.0};
    builder.add_polygon(std::vector<dvec3>{root, root + dvec3(0.02, 0.0, 0.01), tip});
  }
  builder.add_light({-700.0, 3600.0, 3300.0});
  scenes::Camera camera;
  camera.from = {0.0F, 1.5F, 0.0F};
  camera.at = {0.0F, 0.2F, 5.0F};
  builder.add_camera(camera);
  return std::move(builder).build();
}

// In these scenes, float rounds positions on the side of the cube around the light to a quarter of
// a millimeter. Rays that missed a blade by this distance were once reported as shadowed: 14 with
// the first seed. For needles, this still happens to a few rays.
TEST(PencilHits, OfSmallDetailsInLargeScenesAreCorrect) {
  for (const std::uint64_t seed : {1, 2}) {
    const scenes::Scene scene = grass(seed);
    const Outcome outcome =
        verified(scene, rays::make_trace_input(scene, image_over(scene, 320, 240),
                                               rays::parse_ray_choice("shadow")));
    expect_right(outcome);
    EXPECT_EQ(outcome.single.verdict, Verdict::kOk);
    EXPECT_LE(outcome.differing, 8U);
  }
}

// A triangle that a light sees almost edge-on, at a ten-thousandth of its extent, appears narrower
// than the margin of its edges. Two of 34,011 rays were once wrongly reported as shadowed by it.
TEST(PencilHits, OfTrianglesSeenEdgeOnAreCorrect) {
  const scenes::Scene scene = scenes::load_scene("delfines");
  const Outcome outcome = verified(scene, rays::make_trace_input(scene, image_over(scene, 320, 240),
                                                                 rays::parse_ray_choice("shadow")));
  expect_right(outcome);
  EXPECT_EQ(outcome.differing, 0U);
}

/// Returns corners of the octree's cells and points on their edges and faces, and such points of
/// the boxes of the hierarchy that the pencils traverse. Some of the points are outside the scene.
std::vector<scenes::Light> lights_on_borders(const scenes::Scene& scene, Random& random) {
  std::vector<scenes::Light> lights;
  // Puts one, two or all three coordinates on a border.
  const auto add = [&](auto border, const dvec3& elsewhere) {
    for (int borders = 1; borders <= 3; ++borders) {
      dvec3 place = elsewhere;
      const int first = static_cast<int>(random.below(3));
      for (int i = 0; i < borders; ++i) place[(first + i) % 3] = border((first + i) % 3);
      lights.push_back(light_at(place));
    }
  };
  const dvec3 lower(scene.bounds.lower);
  const dvec3 size = dvec3(scene.bounds.upper) - lower;
  const auto anywhere = [&] { return lower + size * (0.5 + 0.8 * point_in_cube(random)); };
  const accel::CellGrid grid = accel::octree::octree_grid(scene, {});
  for (const std::int32_t step : {grid.cells.x / 2, grid.cells.x / 4, 1}) {
    for (int i = 0; i < 3; ++i) {
      add(
          [&](int axis) {
            const auto planes = static_cast<std::uint64_t>(grid.cells.x / step + 1);
            return grid.plane(axis, step * static_cast<std::int32_t>(random.below(planes)));
          },
          anywhere());
    }
  }
  const TileBeam structure(scene, {.max_leaf = 4});
  for (const accel::tile_beam::TileNode& node : structure.hierarchy().nodes) {
    const scenes::Bounds box = node.boxes.get(random.below(node.count));
    add([&](int axis) { return random.below(2) == 0 ? box.lower[axis] : box.upper[axis]; },
        anywhere());
    if (lights.size() > 60) break;
  }
  return lights;
}

TEST(PencilHits, OfLightsOnBordersOfCellsAreCorrect) {
  std::uint64_t beams = 0;
  for (std::uint64_t seed = 200; seed < 216; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    scenes::Scene scene = random_scene(seed, 60);
    scene.lights = lights_on_borders(scene, random);
    const rays::TraceInput input =
        rays::make_trace_input(scene, image_over(scene, 120, 90), rays::parse_ray_choice("shadow"));
    const Outcome outcome = verified(scene, input, {.max_leaf = 4});
    expect_right(outcome);
    beams += outcome.beams;
  }
  EXPECT_GT(beams, 2000U);
}

TEST(PencilHits, OfMirrorsInRandomScenesAreCorrect) {
  std::uint64_t beams = 0;
  for (std::uint64_t seed = 1; seed <= 80; ++seed) {
    SCOPED_TRACE(seed);
    scenes::Scene scene = random_scene(seed, 40);
    for (scenes::Surface& surface : scene.surfaces) surface.specular = 0.5F;
    beams += expect_right_over(scene, image_over(scene, 160, 120, seed % 3 == 0 ? 4 : 1), "mirror");
  }
  EXPECT_GT(beams, 150U);
}

TEST(PencilHits, OfTheCatalogAreCorrect) {
  std::uint64_t beams = 0;
  for (const char* name :
       {"tetra:n=4", "tessellated-balls:slices=8", "casa-de-campo", "habitacion", "teapot",
        "bumpy:triangles=20000", "escena1", "balls:n=2", "shells", "finishes", "closed-room"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    beams += expect_right_over(scene, image_over(scene, 160, 120), "shadow");
    beams += expect_right_over(scene, image_over(scene, 160, 120), "area:samples=4");
    beams += expect_right_over(scene, image_over(scene, 160, 120), "mirror");
  }
  EXPECT_GT(beams, 150U);
}

TEST(PencilHits, OfEveryInstructionSetAreCorrect) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    std::uint64_t beams = 0;
    SCOPED_TRACE(hwy::TargetName(target));
    const tests::OnlyTarget only(target);
    for (const char* name : {"casa-de-campo", "balls:n=2", "teapot"}) {
      SCOPED_TRACE(name);
      const scenes::Scene scene = scenes::load_scene(name);
      beams += expect_right_over(scene, image_over(scene, 80, 60), "shadow");
      beams += expect_right_over(scene, image_over(scene, 80, 60), "area:samples=4");
      beams += expect_right_over(scene, image_over(scene, 80, 60), "mirror");
    }
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      SCOPED_TRACE(seed);
      Random random(seed);
      scenes::Scene scene = random_scene(seed, 40);
      scene.lights = awkward_lights(scene, random);
      for (scenes::Surface& surface : scene.surfaces) surface.specular = 0.5F;
      beams += expect_right_over(scene, image_over(scene, 100, 75), "shadow");
      beams += expect_right_over(scene, image_over(scene, 100, 75), "area:samples=3,size=0.02");
      beams += expect_right_over(scene, image_over(scene, 100, 75), "mirror");
    }
    EXPECT_GT(beams, 200U);
  }
}

// From most origins, a light is completely visible or completely hidden; few are left to the
// pencils.
TEST(PencilHits, OfBundlesAreMostlyFoundOnce) {
  for (const auto& [name, most_open] :
       {std::pair{"bumpy:triangles=20000", 0.5}, {"casa-de-campo", 0.5}, {"balls:n=2", 0.5}}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    const rays::TraceInput input = rays::make_trace_input(
        scene, image_over(scene, 160, 120), rays::parse_ray_choice("area:samples=6,size=0.02"));
    const TileBeam structure(scene, {});
    rays::TraceResults results = rays::make_results(input);
    accel::WorkCounters counters;
    rays::trace(structure, input, results, &counters);
    EXPECT_EQ(counters.by_name()["bundle_origins"], input.size() / 6);
    EXPECT_LT(static_cast<double>(counters.by_name()["open_origins"]),
              most_open * static_cast<double>(input.size() / 6));
  }
}

// A mark that does not fit the pencils is ignored.
TEST(PencilHits, WithMismatchedMarksAreCorrect) {
  const scenes::Scene scene = scenes::load_scene("casa-de-campo");
  const rays::TraceInput input = rays::make_trace_input(scene, image_over(scene, 64, 48),
                                                        rays::parse_ray_choice("area:samples=3"));
  const std::size_t pencils = input.list()->pencils.size();
  ASSERT_GE(pencils, 6U);
  for (const accel::PencilBundle& bundle :
       {accel::PencilBundle{1, pencils}, {pencils, 2}, {pencils + 1, 1}, {0, 0}}) {
    rays::RaySet marked = *input.list();
    marked.marks.bundles = {bundle};
    expect_right(verified(scene, rays::TraceInput(std::move(marked))));
  }
}

TEST(PencilHits, RaysAroundPencilsAreAlsoTraced) {
  const scenes::Scene scene = scenes::load_scene("casa-de-campo");
  const rays::TraceInput input =
      rays::make_trace_input(scene, image_over(scene, 64, 48), rays::parse_ray_choice("shadow"));
  rays::RaySet some = *input.list();
  ASSERT_GT(some.rays.size(), 400U);
  const dvec3 apex = some.pencils.front().apex;
  some.pencils = {{10, 150, apex, true}, {160, 1, apex, true}, {180, 200, apex, true}};
  expect_right(verified(scene, rays::TraceInput(std::move(some))));
}

TEST(PencilHits, OfRaysWithShorterIntervalsAreCorrect) {
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

/// Returns the hits that a structure finds for rays; it may count its work.
rays::TraceResults found_by(const TileBeam& structure, const rays::TraceInput& input,
                            accel::WorkCounters* counters) {
  rays::TraceResults results = rays::make_results(input);
  rays::poison(results);
  rays::trace(structure, input, results, counters);
  return results;
}

TEST(PencilHits, DoNotDependOnTheThreads) {
  // The first scene has enough triangles for its hierarchy to be built by several tasks.
  for (const auto& [name, kind] : {std::pair{"bumpy:triangles=100000", "shadow"},
                                   {"teapot", "shadow"},
                                   {"habitacion", "area:samples=5"},
                                   {"teapot", "mirror"},
                                   {"closed-room", "mirror"}}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    const rays::TraceInput input =
        rays::make_trace_input(scene, image_over(scene, 160, 120), rays::parse_ray_choice(kind));
    const TileBeam alone(scene, {});
    const TileBeam parallel(scene, {.parallel = true});
    accel::WorkCounters expected_counters;
    accel::WorkCounters counters;
    const rays::TraceResults expected = found_by(alone, input, &expected_counters);
    EXPECT_EQ(found_by(parallel, input, &counters), expected);
    EXPECT_EQ(counters.by_name(), expected_counters.by_name());
    EXPECT_GT(counters.by_name()["beams"], 0U);
    // One structure, queried by several threads at once.
    std::vector<rays::TraceResults> at_once(4, rays::make_results(input));
    {
      std::vector<std::jthread> threads;
      for (rays::TraceResults& results : at_once) {
        threads.emplace_back([&] { results = found_by(parallel, input, nullptr); });
      }
    }
    for (const rays::TraceResults& results : at_once) EXPECT_EQ(results, expected);
  }
}

/// Uses shadow rays that pass edges of triangles within several roundings. The light is several
/// times as far away as the triangles are from the coordinate origin, so its roundings exceed K u.
TEST(PencilHits, MatchSingleRaysAtEdgesFarFromTheLight) {
  constexpr int kScenes = 60;
  constexpr std::size_t kRays = 4096;
  Random random(7);
  std::uint64_t beams = 0;
  for (int i = 0; i < kScenes; ++i) {
    SCOPED_TRACE(i);
    scenes::SceneBuilder builder("triangle");
    const std::vector<dvec3> corners{point_in_cube(random), point_in_cube(random),
                                     point_in_cube(random)};
    builder.add_polygon(corners);
    const scenes::Scene scene = std::move(builder).build();
    const dvec3 light(glm::vec3(random.uniform(3.0, 12.0) * random_direction(random)));
    rays::RaySet set;
    set.query = rays::Query::kAnyHit;
    set.may_graze = true;
    set.pencils = {{0, kRays, light, true}};
    for (std::size_t k = 0; k < kRays; ++k) {
      const dvec3& from = corners[k % 3];
      const dvec3 on_edge = from + random.unit() * (corners[(k + 1) % 3] - from);
      const dvec3 beside =
          on_edge + 0x1p-18 * random.unit() * glm::length(light) * random_direction(random);
      const glm::vec3 origin(beside + 0.02 * random.unit() * (beside - light));
      const glm::vec3 direction(light - dvec3(origin));
      set.rays.push_back({.origin = origin,
                          .direction = direction,
                          .t_max = accel::t_before_light(dvec3(origin), light)});
    }
    const Outcome outcome = verified(scene, rays::TraceInput(std::move(set)));
    expect_right(outcome);
    beams += outcome.beams;
  }
  EXPECT_GT(beams, static_cast<std::uint64_t>(kScenes) / 2);
}

}  // namespace
}  // namespace beambench::verify

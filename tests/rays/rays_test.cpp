// Rays other than primary rays: generated, verified, saved and loaded.

#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/rays/fingerprint.hpp"
#include "harness/rays/lights.hpp"
#include "harness/rays/ray_file.hpp"
#include "harness/rays/ray_generators.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/verify/describe.hpp"
#include "harness/verify/differ.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/process_memory.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/planar_mirrors.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/embree_modes.hpp"
#include "tests/pencils.hpp"
#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::rays {
namespace {

using glm::dvec3;

TraceInput input_over(const scenes::Scene& scene, std::string_view rays,
                      Resolution resolution = {64, 48}) {
  return make_trace_input(scene, {scene.cameras.front(), resolution, 1}, parse_ray_choice(rays));
}

TEST(Order, ALabelIsDividedIntoRaysAndOrder) {
  const auto divided = [](const std::string& label) {
    const OrderedLabel found = divide_label(parse_ray_choice(label).label);
    return std::pair(found.rays, std::string(found.order));
  };
  using Both = std::pair<std::string, std::string>;
  EXPECT_EQ(divided("primary"), Both("primary", "list"));
  EXPECT_EQ(divided("diffuse:order=list"), Both("diffuse", "list"));
  EXPECT_EQ(divided("diffuse:order=sorted"), Both("diffuse", "sorted"));
  EXPECT_EQ(divided("ao:order=sorted,samples=2"), Both("ao:samples=2", "sorted"));
  EXPECT_EQ(divided("order=sorted.rays"), Both("order=sorted.rays", "list"));
}

/// Returns all rays of a list as strings, which can be sorted.
std::vector<std::string> texts_of(const TraceInput& input) {
  std::vector<std::string> texts;
  for (const accel::Ray& ray : input.list()->rays) {
    texts.push_back(fmt::format("{} {} {} {} {} {}", ray.origin.x, ray.origin.y, ray.origin.z,
                                ray.direction.x, ray.direction.y, ray.direction.z));
  }
  return texts;
}

TEST(Order, SortedRaysAreTheSameRaysAndMoreCoherent) {
  const scenes::Scene scene = scenes::load_scene("balls:n=1");
  for (const char* kind :
       {"shadow", "area:samples=3", "reflection", "diffuse", "ao", "path", "random"}) {
    const TraceInput list = input_over(scene, kind);
    const char* const separator =
        std::string_view(kind).find(':') == std::string_view::npos ? ":" : ",";
    const TraceInput sorted = input_over(scene, fmt::format("{}{}order=sorted", kind, separator));
    std::vector<std::string> all = texts_of(list), also = texts_of(sorted);
    std::ranges::sort(all);
    std::ranges::sort(also);
    EXPECT_EQ(all, also) << kind;
    EXPECT_NE(fingerprint(list), fingerprint(sorted)) << kind;
    EXPECT_TRUE(sorted.list()->pencils.empty()) << kind;
    if (kind == std::string_view("shadow") || std::string_view(kind).starts_with("area")) {
      continue;  // from few lights: already coherent
    }
    EXPECT_GT(coherence(sorted), coherence(list)) << kind;
  }
}

TEST(Order, ImagesHaveNone) {
  EXPECT_THROW(parse_ray_choice("primary:order=sorted"), InputError);
  EXPECT_THROW(parse_ray_choice("whitted:order=sorted"), InputError);
}

/// Returns one sphere, lit from two sides and seen from the front.
scenes::Scene lonely_sphere() {
  scenes::SceneBuilder builder("sphere");
  builder.add_sphere({1.0, 2.0, 3.0}, 2.0);
  builder.add_light({1.0, 2.0, 23.0});
  builder.add_light({1.0, 2.0, -17.0});
  scenes::Camera camera;
  camera.from = {1.0F, 2.0F, 13.0F};
  camera.at = {1.0F, 2.0F, 3.0F};
  camera.angle = 30.0F;
  builder.add_camera(camera);
  return std::move(builder).build();
}

std::vector<SurfacePoint> points_of(const scenes::Scene& scene) {
  return surface_points(scene, {scene.cameras.front(), 64, 48, 1});
}

TEST(ShadowRays, RunFromFacingSurfacesToTheLight) {
  const scenes::Scene scene = lonely_sphere();
  const auto points = points_of(scene);
  ASSERT_GT(points.size(), 100U);
  const auto rays = shadow_rays(scene.lights, points).rays;
  ASSERT_EQ(rays.size(), points.size());  // no visible point faces the light behind
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_NEAR(glm::length(dvec3(rays[i].origin) - points[i].point), 0.0, 1e-3);
    const dvec3 end = dvec3(rays[i].origin) + dvec3(rays[i].direction);
    EXPECT_NEAR(glm::length(end - dvec3(scene.lights[0].position)), 0.0, 1e-5);
    EXPECT_LT(rays[i].t_max, 1.0F);
    EXPECT_GT(rays[i].t_max, 0.9999F);
  }
}

TEST(AreaLights, AreBallsAroundTheLights) {
  const scenes::Scene scene = lonely_sphere();
  const double diagonal = glm::length(dvec3(scene.bounds.upper - scene.bounds.lower));
  for (const int count : {1, 2, 16, 500}) {
    SCOPED_TRACE(count);
    const std::vector<scenes::Light> points = area_lights(scene, {count, 0.1});
    ASSERT_EQ(points.size(), scene.lights.size() * static_cast<std::size_t>(count));
    for (std::size_t light = 0; light < scene.lights.size(); ++light) {
      dvec3 mean(0.0);
      double nearer = 0.0;  // inside the sphere that halves the ball's volume
      for (int i = 0; i < count; ++i) {
        const auto& point =
            points[light * static_cast<std::size_t>(count) + static_cast<std::size_t>(i)];
        const dvec3 from_center = dvec3(point.position) - dvec3(scene.lights[light].position);
        EXPECT_LE(glm::length(from_center), 0.05 * diagonal * 1.0001);
        mean += from_center / static_cast<double>(count);
        nearer += glm::length(from_center) < 0.05 * diagonal * std::cbrt(0.5) ? 1.0 : 0.0;
        EXPECT_NEAR(point.color.x, light_colors(scene)[light].x / count, 1e-6);
      }
      if (count < 16) continue;
      EXPECT_LT(glm::length(mean), 0.01 * diagonal);
      EXPECT_NEAR(nearer / count, 0.5, 1.0 / std::sqrt(count));
    }
  }
}

// A ball of size 0 is a point light.
TEST(AreaRays, OfPointsAreShadowRays) {
  for (const char* name : {"balls:n=1", "habitacion"}) {
    const scenes::Scene scene = scenes::load_scene(name);
    const TraceInput area = input_over(scene, "area:samples=1,size=0");
    const TraceInput shadow = input_over(scene, "shadow");
    EXPECT_EQ(fingerprint(area), fingerprint(shadow)) << name;
    EXPECT_EQ(area.list()->pencils.size(), shadow.list()->pencils.size()) << name;
  }
}

TEST(ReflectionRays, LeaveAtTheAngleOfIncidence) {
  const scenes::Scene scene = lonely_sphere();
  const auto points = points_of(scene);
  const auto rays = reflection_rays(points).rays;
  ASSERT_EQ(rays.size(), points.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const dvec3 out(rays[i].direction);
    const dvec3& normal = points[i].normal;
    EXPECT_NEAR(glm::length(out), 1.0, 1e-6);
    EXPECT_NEAR(glm::dot(out, normal), -glm::dot(points[i].incoming, normal), 1e-6);
    EXPECT_NEAR(glm::dot(glm::cross(points[i].incoming, out), normal), 0.0, 1e-6);  // one plane
  }
}

/// Returns the rays of a list in the order of their samples.
std::vector<accel::Ray> by_sample(const RayList& list) {
  std::vector<std::size_t> order(list.rays.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return list.samples[i]; });
  std::vector<accel::Ray> rays;
  for (const std::size_t i : order) rays.push_back(list.rays[i]);
  return rays;
}

TEST(MirrorRays, AreTheReflectionRaysOfPlanarMirrors) {
  const scenes::Scene scene = scenes::load_scene("teapot:n=3");
  const MirrorTable mirrors(scene);
  const accel::PrimaryRays image(scene.cameras.front(), 64, 48, 1);
  std::vector<SurfacePoint> points = surface_points(scene, mirrors, image);
  const RayList list = mirror_rays(points, mirrors, image);
  const std::size_t all = points.size();
  std::erase_if(points, [&](const SurfacePoint& at) {
    return mirrors.plane_of(at.primitive) == MirrorTable::kNone;
  });
  EXPECT_LT(points.size(), all);
  EXPECT_EQ(fingerprint(by_sample(list)), fingerprint(reflection_rays(points).rays));
}

// Each light and each mirror has a pencil whose rays all pass through its apex.
TEST(PencilsOfLists, AreLightsAndVirtualEyes) {
  for (const char* name : {"habitacion", "teapot:n=4", "gears:n=2", "ajedrez", "closed-room",
                           "gato-bill", "misil", "casa-de-campo"}) {
    for (const char* kind : {"shadow", "area:samples=3", "mirror"}) {
      SCOPED_TRACE(fmt::format("{} {}", name, kind));
      const scenes::Scene scene = scenes::load_scene(name);
      const accel::PrimaryRays image(scene.cameras.front(), 160, 120, 1);
      const TraceInput input = input_over(scene, kind, {160, 120});
      const RaySet& set = *input.list();
      tests::CheckedPencils checked(scene, image, 16.0);
      checked.add(set.batch());
      EXPECT_EQ(checked.toward + checked.away, set.rays.size());
      EXPECT_EQ(checked.away > 0, kind == std::string_view("mirror"));
    }
  }
}

TEST(DiffuseRays, FollowTheCosineAndTheSeed) {
  const scenes::Scene scene = lonely_sphere();
  const auto points = points_of(scene);
  double cosines = 0.0;
  double squares = 0.0;
  std::size_t count = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const auto rays = diffuse_rays(points, seed).rays;
    ASSERT_EQ(rays.size(), points.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const double cosine = glm::dot(dvec3(rays[i].direction), points[i].normal);
      ASSERT_GT(cosine, -1e-6);
      cosines += cosine;
      squares += cosine * cosine;
      ++count;
    }
  }
  // With density cos / pi, the mean of cos is 2/3 and that of its square is 1/2; the tolerance is
  // five standard errors.
  EXPECT_NEAR(cosines / static_cast<double>(count), 2.0 / 3.0,
              5.0 * std::sqrt(1.0 / 18.0 / static_cast<double>(count)));
  EXPECT_NEAR(squares / static_cast<double>(count), 0.5,
              5.0 * std::sqrt(1.0 / 12.0 / static_cast<double>(count)));
  EXPECT_EQ(fingerprint(diffuse_rays(points, 1).rays), fingerprint(diffuse_rays(points, 1).rays));
  EXPECT_NE(fingerprint(diffuse_rays(points, 1).rays), fingerprint(diffuse_rays(points, 2).rays));
}

/// Returns a camera that looks down, between a floor at y = 0 and a ceiling.
scenes::Scene floor_and_ceiling(double height) {
  scenes::SceneBuilder builder("floor and ceiling");
  for (const double y : {0.0, height}) {
    builder.add_polygon(std::vector<dvec3>{{-9, y, -9}, {9, y, -9}, {9, y, 9}, {-9, y, 9}});
  }
  scenes::Camera camera;
  camera.from = {0.0F, 0.5F, 0.0F};
  camera.at = {0.0F, 0.0F, 0.0F};
  camera.up = {0.0F, 0.0F, 1.0F};
  builder.add_camera(camera);
  return std::move(builder).build();
}

// With density cos / pi, a direction has a cosine above c with probability 1 - c^2.
TEST(OcclusionRays, HitACeilingAsOftenAsTheirLengthImplies) {
  constexpr double kDistance = 2.0;
  for (const double height : {1.0, 1.8, 2.1}) {
    const scenes::Scene scene = floor_and_ceiling(height);
    const auto points = points_of(scene);
    ASSERT_EQ(points.size(), 64U * 48U);
    RaySet set{occlusion_rays(points, 8, kDistance, 1), "ao", Query::kAnyHit, 1};
    ASSERT_EQ(set.rays.size(), 8 * points.size());
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
      ASSERT_EQ(set.rays[i].origin, set.rays[i / 8 * 8].origin);
      ASSERT_EQ(set.samples[i], points[i / 8].sample);
      ASSERT_EQ(set.rays[i].t_max, static_cast<float>(kDistance));
      ASSERT_NEAR(glm::length(dvec3(set.rays[i].direction)), 1.0, 1e-6);
    }
    const auto count = static_cast<double>(set.rays.size());
    const verify::ReferenceHits reference(scene, TraceInput(std::move(set)));
    const double expected = std::max(0.0, 1.0 - height * height / (kDistance * kDistance));
    EXPECT_NEAR(static_cast<double>(reference.hit_count()) / count, expected,
                5.0 * std::sqrt(expected * (1.0 - expected) / count) + 1e-4);
  }
}

TEST(OcclusionRays, AreMeasuredInDiagonalsOfTheScene) {
  const scenes::Scene scene = floor_and_ceiling(3.0);
  const TraceInput input = input_over(scene, "ao:samples=3,distance=0.5,seed=4");
  EXPECT_EQ(input.size(), 3U * 64U * 48U);
  EXPECT_EQ(input.query(), Query::kAnyHit);
  EXPECT_EQ(input.seed(), 4U);
  EXPECT_EQ(input.label(), "ao:samples=3,distance=0.5,seed=4");
  EXPECT_FLOAT_EQ(input.ray(0).t_max, static_cast<float>(0.5 * std::sqrt(2 * 18.0 * 18.0 + 9.0)));
}

// In a closed room no path ends early, and each ray begins at the previous hit.
TEST(PathRays, ContinueFromTheirHits) {
  const scenes::Scene scene = scenes::load_scene("closed-room");
  const auto points = points_of(scene);
  ASSERT_EQ(points.size(), 64U * 48U);
  const MirrorTable mirrors(scene);
  const RayList list = path_rays(scene, mirrors, points, 4, 7);
  ASSERT_EQ(list.rays.size(), 4 * points.size());
  RaySet set{list, "path", Query::kClosestHit, 7};
  const RayList first = diffuse_rays(points, 7);
  set.rays.resize(points.size());
  EXPECT_EQ(fingerprint(set.rays), fingerprint(first.rays));

  set.rays = list.rays;
  const verify::ReferenceHits reference(scene, TraceInput(std::move(set)));
  for (std::size_t i = points.size(); i < list.rays.size(); ++i) {
    const std::size_t before = i - points.size();
    const accel::Ray& ray = list.rays[before];
    ASSERT_TRUE(reference.hits()[before]);
    const dvec3 hit = dvec3(ray.origin) + reference.hits()[before]->t * dvec3(ray.direction);
    ASSERT_EQ(list.samples[i], list.samples[before]);
    ASSERT_LT(glm::distance(dvec3(list.rays[i].origin), hit),
              2.0 * mirrors.lift_at(reference.hits()[before]->primitive, dvec3(ray.origin), hit));
  }
}

TEST(PathRays, EndWhereNothingIsHit) {
  const scenes::Scene scene = lonely_sphere();
  const auto points = points_of(scene);
  EXPECT_EQ(path_rays(scene, MirrorTable(scene), points, 5, 1).rays.size(), points.size());
}

TEST(MakeInput, RefusesListsThatWouldExceedMemory) {
  const scenes::Scene scene = floor_and_ceiling(1.0);
  // Each list has slightly more than 2^28 rays; its size is checked before its rays are counted.
  const auto refusal = [&](const char* kind, const Resolution& resolution) {
    return scenes::thrown_message([&] { input_over(scene, kind, resolution); });
  };
  EXPECT_TRUE(scenes::says(refusal("ao:samples=1024", {513, 512}),
                           {"ao:samples=1024", "262656 places", "lower the resolution or"}));
  EXPECT_TRUE(scenes::says(refusal("path:bounces=64", {2049, 2048}),
                           {"path:bounces=64", "4196352 places", "lower the resolution or"}));
}

TEST(SecondaryRays, DoNotMeetTheSurfaceTheyLeave) {
  const scenes::Scene scene = lonely_sphere();
  for (const char* kind : {"shadow", "area:size=0.5", "reflection", "diffuse", "ao", "path"}) {
    const verify::ReferenceHits reference(scene, input_over(scene, kind));
    EXPECT_EQ(reference.hit_count(), 0U) << kind;
  }
}

TEST(RandomRays, HitAConvexBodyInProportionToItsSurface) {
  const scenes::Scene scene = lonely_sphere();
  constexpr std::size_t kCount = 200'000;
  RaySet set{random_rays(scene.bounds, kCount, 1), "random", Query::kClosestHit, 1};
  ASSERT_EQ(set.rays.size(), kCount);
  const verify::ReferenceHits reference(scene, TraceInput(std::move(set)));
  const double pad = 2.0 * 0x1p-10 * std::sqrt(3.0) * 4.0;  // the box is a little wider
  const double expected = 4.0 * std::numbers::pi * 4.0 / (6.0 * (4.0 + pad) * (4.0 + pad));
  const double share = static_cast<double>(reference.hit_count()) / kCount;
  EXPECT_NEAR(share, expected, 5.0 * std::sqrt(expected * (1.0 - expected) / kCount));
}

TEST(RandomRays, AcceptFlatAndEmptyBoxes) {
  EXPECT_TRUE(random_rays(scenes::Bounds(), 10, 1).rays.empty());
  scenes::Bounds point;
  point.include(glm::vec3(5.0F, 0.0F, 0.0F));
  for (const accel::Ray& ray : random_rays(point, 10, 1).rays) accel::require_valid(ray);
  scenes::Bounds flat = point;
  flat.include(glm::vec3(5.0F, 3.0F, 2.0F));
  EXPECT_EQ(random_rays(flat, 10, 1).rays.size(), 10U);
}

TEST(Coherence, IsTheMeanCosineOfNeighbors) {
  accel::Ray x;
  x.direction = {2.0F, 0.0F, 0.0F};
  accel::Ray y;
  y.direction = {0.0F, 0.1F, 0.0F};
  EXPECT_DOUBLE_EQ(coherence(std::vector{x, x, y, y}), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(coherence(std::vector{x}), 1.0);
  const scenes::Scene scene = lonely_sphere();
  const TraceInput image = input_over(scene, "primary", {5, 4});
  std::vector<accel::Ray> rays;
  for (std::size_t i = 0; i < image.size(); ++i) rays.push_back(image.ray(i));
  EXPECT_NEAR(coherence(image), coherence(rays), 1e-12);
}

TEST(ShareWarning, IsGivenBelowOneAndAboveNinetyNinePercent) {
  const TraceInput image(accel::PrimaryRays(lonely_sphere().cameras.front(), 100, 10, 1));
  EXPECT_TRUE(share_warning(image, 9));
  EXPECT_FALSE(share_warning(image, 10));
  EXPECT_FALSE(share_warning(image, 990));
  EXPECT_TRUE(share_warning(image, 991));
}

TEST(MakeInput, ExplainsWhyThereAreNoRays) {
  scenes::Scene scene = lonely_sphere();
  scene.lights.clear();
  EXPECT_TRUE(
      scenes::says(scenes::thrown_message([&] { input_over(scene, "shadow"); }), {"no lights"}));
  scene.cameras.front().at = {1.0F, 2.0F, 23.0F};
  EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { input_over(scene, "diffuse"); }),
                           {"no diffuse rays", "another camera"}));
}

TEST(MakeInput, ExplainsWhyThereAreNoMirrorRays) {
  const auto reason = [](const scenes::Scene& scene) {
    return scenes::thrown_message([&] { input_over(scene, "mirror"); });
  };
  EXPECT_TRUE(
      scenes::says(reason(lonely_sphere()), {"no planar mirrors", "specular", "reflection"}));
  scenes::Scene scene = scenes::load_scene("teapot:n=2");
  scenes::Camera& camera = scene.cameras.front();
  camera.at = camera.from + (camera.from - camera.at);  // turned around
  EXPECT_TRUE(scenes::says(reason(scene), {"no mirror rays", "planar mirror", "another camera"}));
}

TEST(EveryKindOfRays, FindsExhaustiveAndEmbreeCorrect) {
  std::vector<std::string> structures{"exhaustive", "samet"};
  for (const std::string& mode : tests::embree_modes()) structures.push_back("embree:mode=" + mode);
  for (const char* name : {"tetra:n=3", "escena1:spheres=60", "balls:n=1", "teapot:n=2"}) {
    const scenes::Scene scene = scenes::load_scene(name);
    for (const char* kind :
         {"shadow", "area:samples=3", "reflection", "mirror", "diffuse", "ao", "path", "random"}) {
      if (kind == std::string_view("mirror") && scenes::planar_mirrors(scene).empty()) continue;
      const verify::ReferenceHits reference(scene, input_over(scene, kind));
      for (const std::string& structure : structures) {
        const accel::StructureChoice choice = accel::registry().choose(parse_spec(structure));
        TraceResults results = make_results(reference.input());
        poison(results);
        trace(*choice.build(scene), reference.input(), results);
        const verify::DiffReport report =
            verify::verify_results(reference, results, choice.info().conformance);
        EXPECT_EQ(report.verdict, verify::Verdict::kOk) << name << " " << kind << " " << structure;
        EXPECT_EQ(report.rays, reference.input().size());
      }
    }
  }
}

/// Correct results for shadow rays, which the tests corrupt.
class AnyHitAnswers : public ::testing::Test {
 protected:
  AnyHitAnswers() {
    trace(*accel::registry().choose({"exhaustive", {}}).build(scene_), reference_.input(),
          results_);
  }
  verify::DiffReport verified() const {
    return verify::verify_results(reference_, results_, accel::Conformance::kBitExact);
  }
  std::uint8_t& answer(std::size_t i) { return std::get<AnyHits>(results_)[i]; }
  std::size_t first_that_is(std::uint8_t value) {
    std::size_t i = 0;
    while (answer(i) != value) ++i;
    return i;
  }

  scenes::Scene scene_ = scenes::load_scene("escena1:spheres=60");
  verify::ReferenceHits reference_{scene_, input_over(scene_, "shadow")};
  TraceResults results_ = make_results(reference_.input());
};

TEST_F(AnyHitAnswers, AreOkIfCorrect) {
  const verify::DiffReport report = verified();
  EXPECT_EQ(report.verdict, verify::Verdict::kOk);
  EXPECT_EQ(report.count(verify::DiffClass::kAgree), report.rays);
}

TEST_F(AnyHitAnswers, AreAMismatchIfOneIsWrong) {
  for (const std::uint8_t value : {std::uint8_t{0}, std::uint8_t{1}}) {
    const std::size_t at = first_that_is(value);
    answer(at) = 1 - value;
    const verify::DiffReport report = verified();
    EXPECT_EQ(report.verdict, verify::Verdict::kMismatch);
    ASSERT_EQ(report.examples.size(), 1U);
    EXPECT_EQ(report.examples[0].index, at);
    EXPECT_TRUE(scenes::says(verify::describe(scene_, reference_.input(), report.examples[0]),
                             {fmt::format("ray {}: structure_error", at),
                              value == 1 ? "a hit was lost" : "there is none"}));
    answer(at) = value;
  }
}

TEST_F(AnyHitAnswers, AreAMismatchIfOneIsInvalid) {
  answer(7) = 2;
  EXPECT_EQ(verified().count(verify::DiffClass::kStructureError), 1U);
  poison(results_);
  EXPECT_EQ(verified().count(verify::DiffClass::kStructureError), reference_.input().size());
}

TEST_F(AnyHitAnswers, AreAllMissesForABaseline) {
  EXPECT_EQ(verify::verify_results(reference_, results_, accel::Conformance::kBaseline).verdict,
            verify::Verdict::kMismatch);
  EXPECT_EQ(verify::verify_results(reference_, make_results(reference_.input()),
                                   accel::Conformance::kBaseline)
                .verdict,
            verify::Verdict::kBaseline);
}

TEST(AnyHitOfAGrazingRay, MayBeEither) {
  scenes::SceneBuilder builder("two triangles");
  const dvec3 near[] = {{0.0, -1.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  const dvec3 far[] = {{-3.0, -3.0, -5.0}, {3.0, -3.0, -5.0}, {0.0, 3.0, -5.0}};
  builder.add_polygon(near);
  builder.add_polygon(far);
  const scenes::Scene scene = std::move(builder).build();
  const auto verdict_on = [&](float x, float t_max, std::uint8_t answer) {
    accel::Ray ray;
    ray.origin = {x, 0.0F, 4.0F};
    ray.direction = {0.0F, 0.0F, -1.0F};
    ray.t_max = t_max;
    const verify::ReferenceHits reference(scene,
                                          TraceInput(RaySet{{{ray}}, "a ray", Query::kAnyHit}));
    return verify::verify_results(reference, AnyHits{answer}, accel::Conformance::kTolerance)
        .examples;
  };
  const auto class_of = [](const std::vector<verify::Mismatch>& examples) {
    return examples.empty() ? verify::DiffClass::kAgree : examples[0].diff_class;
  };
  // Along the near triangle's edge, either result is allowed unless the far triangle is within
  // reach.
  for (const std::uint8_t answer : {std::uint8_t{0}, std::uint8_t{1}}) {
    EXPECT_NE(class_of(verdict_on(0.0F, 6.0F, answer)), verify::DiffClass::kStructureError);
    EXPECT_NE(class_of(verdict_on(-1e-7F, 6.0F, answer)), verify::DiffClass::kStructureError);
    EXPECT_NE(class_of(verdict_on(0.2F, 4.0F, answer)),
              verify::DiffClass::kStructureError);  // ends on it
  }
  EXPECT_EQ(class_of(verdict_on(0.0F, 20.0F, 0)), verify::DiffClass::kStructureError);
  EXPECT_EQ(class_of(verdict_on(-0.01F, 6.0F, 1)), verify::DiffClass::kStructureError);
  EXPECT_EQ(class_of(verdict_on(0.2F, 3.9F, 1)), verify::DiffClass::kStructureError);
  EXPECT_EQ(class_of(verdict_on(0.2F, 4.1F, 0)), verify::DiffClass::kStructureError);
}

class RayFile : public ::testing::Test {
 protected:
  RayFile() { write_ray_file(path_, set_, {{"why", "a test"}}); }

  std::string refusal() const {
    return scenes::thrown_message([&] { read_ray_file(path_); });
  }
  void write(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "some.rays";
  scenes::Scene scene_ = lonely_sphere();
  RaySet set_ = *input_over(scene_, "diffuse:seed=9").list();
};

TEST_F(RayFile, HoldsTheSameRays) {
  const TraceInput read = input_over(scene_, path_.string());
  EXPECT_EQ(fingerprint(read), fingerprint(set_.rays));
  EXPECT_EQ(read.seed(), 9U);
  EXPECT_EQ(read.query(), Query::kClosestHit);
  EXPECT_EQ(read.label(), path_.string());
}

TEST_F(RayFile, HoldsTheSamePencils) {
  const scenes::Scene scene = scenes::load_scene("gears:n=2");
  for (const char* kind : {"shadow", "mirror"}) {
    const TraceInput made = input_over(scene, kind);
    ASSERT_FALSE(made.list()->pencils.empty());
    write_ray_file(path_, *made.list(), {});
    const TraceInput read = input_over(scene, path_.string());
    EXPECT_EQ(fingerprint(read), fingerprint(made));
    ASSERT_EQ(read.list()->pencils.size(), made.list()->pencils.size());
    for (std::size_t i = 0; i < read.list()->pencils.size(); ++i) {
      const accel::Pencil& pencil = read.list()->pencils[i];
      const accel::Pencil& expected = made.list()->pencils[i];
      EXPECT_EQ(pencil.first, expected.first);
      EXPECT_EQ(pencil.count, expected.count);
      EXPECT_EQ(pencil.apex, expected.apex);
      EXPECT_EQ(pencil.toward, expected.toward);
    }
  }
}

TEST_F(RayFile, NamesAnInvalidPencil) {
  const std::string rest = read_text(path_).substr(read_text(path_).find("}\n") + 2);
  const auto header = [&](const std::string& pencils) {
    return fmt::format("beambench-rays 1\n{{\"query\":\"any\",\"rays\":{},\"pencils\":{}}}\n",
                       set_.rays.size(), pencils) +
           rest;
  };
  const std::string good = R"({"first":4,"count":6,"apex":[1,2,3],"toward":true})";
  write(header("[" + good + "]"));
  EXPECT_EQ(read_ray_file(path_).pencils.size(), 1U);
  write(header(good));
  EXPECT_TRUE(scenes::says(refusal(), {"some.rays", "\"pencils\" is not a list"}));
  for (const auto& [bad, why] : std::initializer_list<std::pair<const char*, const char*>>{
           {R"({"first":9,"count":6,"apex":[1,2,3],"toward":true})", "expected 10 or later"},
           {R"({"first":-1,"count":6,"apex":[1,2,3],"toward":true})", "first"},
           {R"({"first":10,"count":0,"apex":[1,2,3],"toward":true})", "do not fit"},
           {R"({"first":10,"count":1000000,"apex":[1,2,3],"toward":true})", "do not fit"},
           {R"({"first":10,"count":1,"apex":[1,2],"toward":true})", "apex"},
           {R"({"first":10,"count":1,"apex":[1,2,null],"toward":true})", "apex"},
           {R"({"first":10,"count":1,"apex":[1,2,1e999],"toward":true})", "not a JSON object"},
           {R"({"first":10,"count":1,"apex":[1,2,3],"toward":1})", "toward"},
           {R"({"first":10,"count":1,"apex":[1,2,3]})", "toward"},
           {"7", "first"}}) {
    write(header("[" + good + "," + bad + "]"));
    EXPECT_TRUE(scenes::says(refusal(), {"some.rays", why})) << bad;
    if (why != std::string_view("not a JSON object")) {
      EXPECT_TRUE(scenes::says(refusal(), {"pencil 1"})) << bad;
    }
  }
}

TEST_F(RayFile, OfAnotherSceneIsRefused) {
  const scenes::Scene other = scenes::load_scene("tetra:n=1");
  EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { input_over(other, path_.string()); }),
                           {"some.rays", "made for a scene with hash", "tetra:n=1"}));
}

TEST_F(RayFile, ThatIsDamagedIsRefused) {
  const std::string whole = read_text(path_);
  std::string damaged = whole;
  damaged.back() = static_cast<char>(damaged.back() ^ 1);
  write(damaged);
  EXPECT_TRUE(scenes::says(refusal(), {"some.rays", "hash"}));
  write(whole.substr(0, whole.size() - 5));
  EXPECT_TRUE(scenes::says(refusal(), {"some.rays", "bytes of rays"}));
  write(whole + "x");
  EXPECT_TRUE(scenes::says(refusal(), {"some.rays", "bytes of rays"}));
}

/// The header from a pipe may claim gigabytes of rays that never arrive.
TEST_F(RayFile, ThroughAPipeTakesOnlyTheMemoryOfItsData) {
  const std::filesystem::path pipe = folder_.path() / "pipe.rays";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int writer = ::open(pipe.c_str(), O_RDWR | O_CLOEXEC);
  const std::string header = "beambench-rays 1\n{\"query\": \"closest\", \"rays\": 268435456}\n";
  ASSERT_EQ(::write(writer, header.data(), header.size()), static_cast<ssize_t>(header.size()));
  const auto before = mapped_data_bytes();
  std::optional<std::uint64_t> meanwhile;
  std::thread closing([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));  // by then, the reader is waiting
    meanwhile = mapped_data_bytes();
    ::close(writer);
  });
  EXPECT_NE(scenes::thrown_message([&] { read_ray_file(pipe); }), "(nothing thrown)");
  closing.join();
  EXPECT_LT(meanwhile.value_or(0), before.value_or(0) + (std::uint64_t{1} << 30U));
}

TEST_F(RayFile, OfAnotherFormatIsRefused) {
  std::filesystem::remove(path_);
  EXPECT_TRUE(scenes::says(refusal(), {"some.rays: cannot be read: No such file"}));
  for (const char* text :
       {"", "v\nfrom 0 0 0\n", "beambench-rays 2\n{}\n", "beambench-rays 1",
        "beambench-rays 1\n[]\n", "beambench-rays 1\n{\"query\":\"all\",\"rays\":1}\n",
        "beambench-rays 1\n{\"query\":\"any\"}\n",
        "beambench-rays 1\n{\"query\":\"any\",\"rays\":0}\n",
        "beambench-rays 1\n{\"query\":\"any\",\"rays\":-1}\n",
        "beambench-rays 1\n{\"query\":\"any\",\"rays\":1e99}\n",
        "beambench-rays 1\n{\"query\":\"any\",\"rays\":1,\"hash\":5}\n",
        "beambench-rays 1\n{\"query\":\"any\",\"rays\":1,\"seed\":\"x\"}\n",
        "beambench-rays 1\n{\"query\":\"any\",\"rays\":200000000}\n"}) {
    write(text);
    EXPECT_TRUE(scenes::says(refusal(), {"some.rays"})) << text;
  }
}

TEST_F(RayFile, NamesAnInvalidRay) {
  set_.rays[3].direction = glm::vec3(0.0F);
  write_ray_file(path_, set_, {});
  EXPECT_TRUE(scenes::says(refusal(), {"some.rays", "ray 3"}));
}

}  // namespace
}  // namespace beambench::rays

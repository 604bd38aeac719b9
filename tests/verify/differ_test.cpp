// The differ: correct structures pass, planted faults do not.

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "harness/verify/describe.hpp"
#include "harness/verify/tolerance.hpp"
#include "harness/verify/verify_ray.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/embree_modes.hpp"
#include "tests/random_scene.hpp"
#include "tests/verify/exact_answers.hpp"
#include "tests/verify/first_example.hpp"

namespace beambench::verify {
namespace {

using tests::embree_modes;
using tests::first_example;
using tests::random_ray;
using tests::random_scene;

accel::HitBuffer traced(const std::string& structure, const scenes::Scene& scene,
                        const accel::PrimaryRays& rays) {
  accel::HitBuffer buffer(rays.width(), rays.height(), rays.samples());
  accel::registry().choose(parse_spec(structure)).build(scene)->closest_hits(rays, buffer, {});
  return buffer;
}

TEST(Oracle, ReturnsTheExactAnswer) {
  std::uint64_t rays = 0;
  std::uint64_t not_equal = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const scenes::Scene scene = random_scene(seed, 30);
    const accel::oracle::Oracle oracle(scene, 20'000.0);
    Random random(seed);
    for (int i = 0; i < 300; ++i) {
      const accel::Ray ray = random_ray(scene, random);
      const auto found = oracle.closest_hit(ray);
      const auto exact = tests::exact_closest_hit(scene, ray);
      ++rays;
      if (found.has_value() == exact.has_value() &&
          (!exact || (found->primitive == exact->primitive &&
                      std::abs(found->t - exact->t) <= 1e-9 * (1.0 + exact->t)))) {
        continue;
      }
      // Any other differences must be ties or grazes.
      ++not_equal;
      std::optional<accel::Hit> rounded;
      if (found) rounded = accel::Hit{static_cast<float>(found->t), found->primitive};
      ASSERT_TRUE(tests::class_of(scene, ray, rounded).has_value()) << scene.name << " ray " << i;
    }
  }
  EXPECT_LT(not_equal, rays / 10);
}

TEST(Differ, FindsNoErrorInExhaustiveSearchOnRandomScenes) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const scenes::Scene scene = random_scene(seed, 40);
    const accel::PrimaryRays rays(scene.cameras.front(), 64, 64, 1);
    const ReferenceHits reference(scene, rays);
    const DiffReport report =
        verify_results(reference, traced("exhaustive", scene, rays), accel::Conformance::kBitExact);
    ASSERT_EQ(report.verdict, Verdict::kOk) << first_example(reference, report);
    ASSERT_EQ(report.count(DiffClass::kOracleError), 0U) << first_example(reference, report);
    ASSERT_EQ(report.rays, rays.count());
  }
}

TEST(Differ, AcceptsEveryModeOfEmbree) {
  std::vector<std::string> variants = {"mode=packet16,coherent=false", "quality=low",
                                       "quality=medium", "robust=false"};
  for (const std::string& mode : tests::embree_modes()) variants.push_back("mode=" + mode);
  for (const char* name : {"tetra:n=4", "escena1", "balls:n=2", "bumpy:triangles=2000"}) {
    const scenes::Scene scene = scenes::load_scene(name);
    const accel::PrimaryRays rays(scene.cameras.front(), 200, 160, 1);
    const ReferenceHits reference(scene, rays);
    for (const std::string& variant : variants) {
      const std::string structure = "embree:" + variant;
      const DiffReport report =
          verify_results(reference, traced(structure, scene, rays), accel::Conformance::kTolerance);
      EXPECT_EQ(report.verdict, Verdict::kOk) << name << " " << structure << "\n"
                                              << first_example(reference, report);
      EXPECT_GT(report.hits, 0U);
    }
  }
}

TEST(Differ, AcceptsEmbreesOwnConesAndInsideSpheres) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const scenes::Scene scene = random_scene(4 * seed + 3, 40);  // not snapped, repeated or remote
    const accel::PrimaryRays rays(scene.cameras.front(), 64, 64, 1);
    const ReferenceHits reference(scene, rays);
    for (const std::string& mode : tests::embree_modes()) {
      const std::string structure = "embree:mode=" + mode;
      const DiffReport report =
          verify_results(reference, traced(structure, scene, rays), accel::Conformance::kTolerance);
      ASSERT_EQ(report.verdict, Verdict::kOk) << structure << "\n"
                                              << first_example(reference, report);
    }
  }
}

/// A sphere, a polygon facing the camera and, behind both, a wall and a cone; seen along -z.
class FaultyBuffer : public ::testing::Test {
 protected:
  static constexpr scenes::PrimitiveId kSphere = 0;
  static constexpr scenes::PrimitiveId kTile = 1;
  static constexpr scenes::PrimitiveId kWall = 2;
  static constexpr scenes::PrimitiveId kCone = 3;

  static scenes::Scene make_scene() {
    scenes::SceneBuilder builder("planted");
    builder.add_sphere({-1.0, 0.0, 0.0}, 0.8);
    add_square(builder, {1.0, 0.0, 0.0}, 0.8);
    add_square(builder, {0.0, 0.0, -2.0}, 3.0);
    builder.add_cone({-1.0, -1.5, 0.0}, 0.4, {1.0, -1.5, 0.0}, 0.2);
    scenes::Camera camera;
    camera.from = {0.0F, 0.0F, 4.0F};
    camera.at = {0.0F, 0.0F, 0.0F};
    camera.angle = 50.0F;
    builder.add_camera(camera);
    return std::move(builder).build();
  }
  static void add_square(scenes::SceneBuilder& builder, const glm::dvec3& center, double half) {
    const glm::dvec3 corners[] = {
        center + glm::dvec3(-half, -half, 0.0), center + glm::dvec3(half, -half, 0.0),
        center + glm::dvec3(half, half, 0.0), center + glm::dvec3(-half, half, 0.0)};
    builder.add_polygon(corners);
  }

  /// Returns the index of a pixel that sees the point.
  std::size_t seeing(double x, double y, double z) const {
    const double scale = 0.5 * 65.0 / std::tan(25.0 * 3.14159265358979 / 180.0) / (4.0 - z);
    return buffer_.index(static_cast<int>(32.5 + x * scale), static_cast<int>(32.5 - y * scale), 0);
  }
  std::size_t on_sphere() const { return seeing(-1.0, 0.1, 0.8); }
  std::size_t on_tile() const { return seeing(1.0, 0.1, 0.0); }
  std::size_t on_wall() const { return seeing(0.0, 1.5, -2.0); }
  std::size_t on_cone() const { return seeing(0.0, -1.5, 0.3); }

  DiffReport verified() const {
    return verify_results(reference_, buffer_, accel::Conformance::kTolerance);
  }
  void expect_structure_error() const {
    const DiffReport report = verified();
    EXPECT_EQ(report.verdict, Verdict::kMismatch);
    EXPECT_EQ(report.count(DiffClass::kStructureError), 1U);
    EXPECT_EQ(report.count(DiffClass::kAgree), report.rays - 1)
        << first_example(reference_, report);
    ASSERT_EQ(report.examples.size(), 1U);
    EXPECT_EQ(report.examples.front().diff_class, DiffClass::kStructureError);
  }
  void shift(std::size_t index, double tolerances) {
    accel::Hit hit = *buffer_.get(index);
    const accel::Ray ray = rays_.ray(static_cast<int>(index % 65), static_cast<int>(index / 65), 0);
    hit.t = static_cast<float>(hit.t + tolerances * tolerance(ray, hit.t));
    buffer_.set(index, hit);
  }

  scenes::Scene scene_ = make_scene();
  accel::PrimaryRays rays_{scene_.cameras.front(), 65, 65, 1};
  ReferenceHits reference_{scene_, rays_};
  accel::HitBuffer buffer_ = traced("exhaustive", scene_, rays_);
};

TEST_F(FaultyBuffer, CorrectBufferHasNoFaults) {
  const DiffReport report = verified();
  EXPECT_EQ(report.verdict, Verdict::kOk);
  EXPECT_EQ(report.count(DiffClass::kAgree), report.rays);
  EXPECT_TRUE(report.examples.empty());
  EXPECT_EQ(buffer_.get(on_sphere())->primitive, kSphere);
  EXPECT_EQ(buffer_.get(on_tile())->primitive, kTile);
  EXPECT_EQ(buffer_.get(on_wall())->primitive, kWall);
  EXPECT_EQ(buffer_.get(on_cone())->primitive, kCone);
}

TEST_F(FaultyBuffer, ShiftOfTByTenTolerances) {
  for (const std::size_t index : {on_sphere(), on_tile(), on_wall(), on_cone()}) {
    for (const double shifted : {10.0, -10.0}) {
      const accel::Hit before = *buffer_.get(index);
      shift(index, shifted);
      expect_structure_error();
      buffer_.set(index, before);
    }
  }
}

TEST_F(FaultyBuffer, ShiftOfTBelowTheToleranceAgrees) {
  for (const std::size_t index : {on_sphere(), on_tile(), on_wall(), on_cone()}) shift(index, 0.4);
  EXPECT_EQ(verified().count(DiffClass::kAgree), verified().rays);
  EXPECT_EQ(verified().verdict, Verdict::kOk);
}

TEST_F(FaultyBuffer, HitReplacedByAMiss) {
  buffer_.set(on_tile(), std::nullopt);
  expect_structure_error();
  EXPECT_TRUE(verified().examples.front().searched);
  EXPECT_EQ(verified().examples.front().exact->primitive, kTile);
}

TEST_F(FaultyBuffer, FartherPrimitiveBehindTheRightOne) {
  const accel::Ray ray =
      rays_.ray(static_cast<int>(on_tile() % 65), static_cast<int>(on_tile() / 65), 0);
  buffer_.set(on_tile(), accel::Hit{(ray.origin.z + 2.0F) / -ray.direction.z, kWall});
  expect_structure_error();
}

TEST_F(FaultyBuffer, InventedHit) {
  buffer_.set(on_wall(), accel::Hit{4.0F, kTile});
  expect_structure_error();
}

TEST_F(FaultyBuffer, RightPointWithTheWrongPrimitive) {
  buffer_.set(on_tile(), accel::Hit{buffer_.get(on_tile())->t, kSphere});
  expect_structure_error();
}

TEST_F(FaultyBuffer, FarSideOfTheSphereAndTheCone) {
  // Both far points lie on the surface to the last bit, but are nevertheless wrong.
  for (const auto& [index, id] : {std::pair(on_sphere(), kSphere), std::pair(on_cone(), kCone)}) {
    const accel::Hit before = *buffer_.get(index);
    accel::Ray ray = rays_.ray(static_cast<int>(index % 65), static_cast<int>(index / 65), 0);
    ray.t_min = before.t + 0.01F;
    const auto far_side = tests::exact_closest_hit(scene_, ray);
    ASSERT_EQ(far_side->primitive, id);
    buffer_.set(index, accel::Hit{static_cast<float>(far_side->t), id});
    expect_structure_error();
    buffer_.set(index, before);
  }
}

TEST_F(FaultyBuffer, InvalidAnswers) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const accel::Hit none[] = {{nan, kTile},
                             {4.0F, 4},
                             {4.0F, scenes::kNoPrimitive - 1},
                             {-4.0F, kTile},
                             {accel::kInfinity, kTile},
                             {-accel::kInfinity, kTile},
                             {nan, scenes::kNoPrimitive},
                             {4.0F, scenes::kNoPrimitive}};
  const accel::Hit before = *buffer_.get(on_tile());
  for (const accel::Hit& answer : none) {
    buffer_.t()[on_tile()] = answer.t;
    buffer_.primitive()[on_tile()] = answer.primitive;
    expect_structure_error();
    EXPECT_FALSE(describe(scene_, rays_, verified().examples.front()).empty());
  }
  buffer_.set(on_tile(), before);
  EXPECT_EQ(verified().verdict, Verdict::kOk);
}

TEST_F(FaultyBuffer, ErrorOfTheOracleIsNotAttributedToTheStructure) {
  std::vector<std::optional<accel::oracle::ExactHit>> hits(reference_.hits().begin(),
                                                           reference_.hits().end());
  hits[on_tile()] = std::nullopt;
  hits[on_wall()] = accel::oracle::ExactHit{4.0, kTile};
  const ReferenceHits wrong(scene_, rays_, hits);
  const DiffReport report = verify_results(wrong, buffer_, accel::Conformance::kTolerance);
  EXPECT_EQ(report.count(DiffClass::kOracleError), 2U);
  EXPECT_EQ(report.verdict, Verdict::kOk);
}

TEST_F(FaultyBuffer, DescriptionNamesPixelRayBothHitsAndTheExactAnswer) {
  buffer_.set(on_tile(), std::nullopt);
  const DiffReport report = verified();
  const Mismatch& mismatch = report.examples.at(0);
  EXPECT_EQ(mismatch.index, on_tile());
  const std::string text = describe(scene_, rays_, mismatch);
  EXPECT_NE(text.find("pixel ("), std::string::npos) << text;
  EXPECT_NE(text.find("from (0, 0, 4) along ("), std::string::npos) << text;
  EXPECT_NE(text.find("structure miss"), std::string::npos) << text;
  EXPECT_NE(text.find("oracle    primitive 1 (polygon) at t = 4"), std::string::npos) << text;
  EXPECT_NE(text.find("exact     primitive 1 (polygon) at t = 4"), std::string::npos) << text;
  EXPECT_NE(text.find("lost"), std::string::npos) << text;
}

TEST_F(FaultyBuffer, AllAreCountedAndAFewShown) {
  for (std::size_t i = 0; i < buffer_.size(); ++i) buffer_.set(i, std::nullopt);
  const DiffReport report = verified();
  EXPECT_EQ(report.verdict, Verdict::kMismatch);
  EXPECT_EQ(report.count(DiffClass::kStructureError) + report.count(DiffClass::kGraze),
            report.hits);
  EXPECT_LE(report.examples.size(), 2 * DiffReport::kMaxExamples);
  EXPECT_EQ(report.examples.front().diff_class, DiffClass::kStructureError);
}

TEST_F(FaultyBuffer, BufferOfAnotherSizeIsACallersError) {
  EXPECT_THROW(
      verify_results(reference_, accel::HitBuffer(64, 65, 1), accel::Conformance::kTolerance),
      std::logic_error);
}

TEST_F(FaultyBuffer, BaselineMustReportOnlyMisses) {
  EXPECT_EQ(verify_results(reference_, buffer_, accel::Conformance::kBaseline).verdict,
            Verdict::kMismatch);
  const DiffReport silent =
      verify_results(reference_, accel::HitBuffer(65, 65, 1), accel::Conformance::kBaseline);
  EXPECT_EQ(silent.verdict, Verdict::kBaseline);
  EXPECT_EQ(silent.count(DiffClass::kStructureError), 0U);
}

/// Adds one primitive of each kind, with ids 0, 1 and 2.
void add_triangle_sphere_and_cone(scenes::SceneBuilder& builder) {
  const glm::dvec3 corners[] = {{0.0, -1.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  builder.add_polygon(corners);
  builder.add_sphere({-2.0, 0.0, 0.0}, 1.0);
  builder.add_cone({4.0, -1.0, 0.0}, 1.0, {4.0, 1.0, 0.0}, 1.0);
}

/// Rays that pass a triangle's edge and a sphere's silhouette at a chosen distance, in units of K
/// u.
class Grazing : public ::testing::Test {
 protected:
  static scenes::Scene make_scene() {
    scenes::SceneBuilder builder("grazing");
    add_triangle_sphere_and_cone(builder);
    return std::move(builder).build();
  }
  std::optional<DiffClass> missing(double x, double y, scenes::PrimitiveId id) const {
    accel::Ray ray;
    ray.origin = glm::vec3(static_cast<float>(x), static_cast<float>(y), 2.0F);
    const auto exact = tests::exact_closest_hit(scene_, ray);
    EXPECT_TRUE(exact && exact->primitive == id) << x << " " << y;
    return tests::class_of(scene_, ray, std::nullopt);
  }
  /// Returns K u near a point passed by a ray that starts 2 in front of it.
  static double unit(double x, double y) {
    const accel::Ray ray{{static_cast<float>(x), static_cast<float>(y), 2.0F}};
    return tolerance(ray, glm::dvec3(x, y, 0.0));
  }

  scenes::Scene scene_ = make_scene();
};

TEST_F(Grazing, IsWithinOneToleranceOfAnEdge) {
  EXPECT_EQ(missing(0.5 * unit(0.0, 0.0), 0.0, 0), DiffClass::kGraze);
  EXPECT_EQ(missing(2.0 * unit(0.0, 0.0), 0.0, 0), std::nullopt);
}

TEST_F(Grazing, IsWithinOneToleranceOfASilhouette) {
  EXPECT_EQ(missing(-1.0 - 0.5 * unit(-1.0, 0.0), 0.0, 1), DiffClass::kGraze);
  EXPECT_EQ(missing(-1.0 - 2.0 * unit(-1.0, 0.0), 0.0, 1), std::nullopt);
  EXPECT_EQ(missing(3.0 + 0.5 * unit(3.0, 0.0), 0.0, 2), DiffClass::kGraze);
  EXPECT_EQ(missing(3.0 + 2.0 * unit(3.0, 0.0), 0.0, 2), std::nullopt);
}

TEST_F(Grazing, IsWithinOneToleranceOfARim) {
  EXPECT_EQ(missing(4.5, 1.0 - 0.5 * unit(4.5, 1.0), 2), DiffClass::kGraze);
  EXPECT_EQ(missing(4.5, 1.0 - 2.0 * unit(4.5, 1.0), 2), std::nullopt);
}

/// Rays that begin or end at a chosen distance from a surface's tangent plane, in units of K u.
class EndsAtASurface : public ::testing::Test {
 protected:
  /// A place on a primitive of each kind where its normal is +z.
  struct Place {
    const char* kind;
    glm::dvec3 point;
  };
  static constexpr Place kPlaces[] = {
      {"triangle", {0.25, 0.125, 0.0}}, {"sphere", {-2.0, 0.0, 1.0}}, {"cone", {4.0, 0.25, 1.0}}};
  /// The end of the ray that is near the surface.
  enum class End { kOrigin, kTMin, kTMax };

  static scenes::Scene make_scene() {
    scenes::SceneBuilder builder("ends");
    add_triangle_sphere_and_cone(builder);
    const glm::dvec3 ceiling[] = {
        {-9.0, -9.0, 3.0}, {9.0, -9.0, 3.0}, {9.0, 9.0, 3.0}, {-9.0, 9.0, 3.0}};
    builder.add_polygon(ceiling);
    return std::move(builder).build();
  }

  /// Returns a ray above the surface except for one end, which is `tolerances` K u above the
  /// point's plane (below it if negative). The ray is inclined so that along the ray, this end is
  /// twice as far from the plane.
  accel::Ray ray_at(const Place& place, End end, double tolerances, double length = 0.5) const {
    const glm::dvec3 slope(std::sqrt(0.75), 0.0, 0.5);
    const glm::dvec3 above = place.point + length * slope;
    const glm::dvec3 below = place.point - length * slope;
    // The tolerance depends on the origin, so a first ray without an offset determines it.
    double offset = 0.0;
    accel::Ray ray;
    for (int turn = 0; turn < 2; ++turn) {
      const glm::dvec3 up(0.0, 0.0, offset);
      ray.origin = glm::vec3(up + (end == End::kOrigin ? place.point
                                   : end == End::kTMin ? below
                                                       : above));
      const glm::dvec3 target = up + (end == End::kTMax ? place.point : above);
      ray.direction = glm::vec3(target - glm::dvec3(ray.origin));
      ray.t_min = end == End::kTMin ? 0.5F : 0.0F;
      ray.t_max = 1.0F;
      offset = tolerances * tolerance(ray, place.point);
    }
    return ray;
  }

  Mismatch verified(const accel::Ray& ray, bool answer) const {
    rays::RaySet set;
    set.rays = {ray};
    set.query = rays::Query::kAnyHit;
    const rays::TraceInput input(std::move(set));
    const accel::oracle::Oracle oracle(scene_, 100.0);
    Mismatch found =
        candidate_mismatch(input, rays::AnyHits{static_cast<std::uint8_t>(answer ? 1 : 0)}, 0,
                           oracle.closest_hit(ray));
    verify_ray(scene_, accel::Conformance::kTolerance, found);
    return found;
  }

  /// Expects wrong results to be classed as `expected` if an end is `tolerances` K u from a
  /// surface.
  void expect_class(double tolerances, DiffClass expected) const {
    for (const Place& place : kPlaces) {
      for (const End end : {End::kOrigin, End::kTMin, End::kTMax}) {
        SCOPED_TRACE(std::string(place.kind) + ", end " + std::to_string(static_cast<int>(end)));
        const accel::Ray ray = ray_at(place, end, tolerances);
        const bool is_hit = tests::exact_closest_hit(scene_, ray).has_value();
        ASSERT_EQ(is_hit, tolerances < 0.0);
        EXPECT_EQ(verified(ray, is_hit).diff_class, DiffClass::kAgree);
        const Mismatch found = verified(ray, !is_hit);
        EXPECT_EQ(found.diff_class, expected) << found.reason;
      }
    }
  }

  scenes::Scene scene_ = make_scene();
};

TEST_F(EndsAtASurface, AnyHitReportedJustBeyondAnEndIsAGraze) {
  expect_class(0.1, DiffClass::kGraze);
  expect_class(0.9, DiffClass::kGraze);
}

TEST_F(EndsAtASurface, AnyHitReportedFartherBeyondIsAnError) {
  expect_class(1.1, DiffClass::kStructureError);
  expect_class(10.0, DiffClass::kStructureError);
}

TEST_F(EndsAtASurface, AnyHitLostJustBeforeAnEndIsAGraze) {
  expect_class(-0.1, DiffClass::kGraze);
  expect_class(-0.9, DiffClass::kGraze);
}

TEST_F(EndsAtASurface, AnyHitLostFartherBeforeIsAnError) {
  expect_class(-1.1, DiffClass::kStructureError);
  expect_class(-10.0, DiffClass::kStructureError);
}

// Surfaces beyond one end excuse neither a hit on the way nor one beyond the other end.
TEST_F(EndsAtASurface, LosingAnotherHitIsAnError) {
  for (const Place& place : kPlaces) {
    SCOPED_TRACE(place.kind);
    for (const double tolerances : {0.5, -0.5}) {
      const accel::Ray through_ceiling = ray_at(place, End::kTMax, tolerances, 7.0);
      ASSERT_TRUE(tests::exact_closest_hit(scene_, through_ceiling).has_value());
      EXPECT_EQ(verified(through_ceiling, false).diff_class, DiffClass::kStructureError);
      EXPECT_EQ(verified(through_ceiling, true).diff_class, DiffClass::kAgree);
    }
  }
}

// The end is within K u of the triangle's plane and in its box, but outside the triangle.
TEST_F(EndsAtASurface, AnyHitReportedBesideATriangleIsAnError) {
  const Place beside{"beside", {0.75, 0.75, 0.0}};
  for (const End end : {End::kOrigin, End::kTMin, End::kTMax}) {
    for (const double tolerances : {0.5, -0.5}) {
      const accel::Ray ray = ray_at(beside, end, tolerances);
      ASSERT_FALSE(tests::exact_closest_hit(scene_, ray).has_value());
      EXPECT_EQ(verified(ray, true).diff_class, DiffClass::kStructureError);
    }
  }
}

TEST(GrazeBudget, IsTwoForASmallImage) {
  // The middle column of pixels looks exactly along an edge of a triangle, which a structure may or
  // may not see.
  scenes::SceneBuilder builder("edge");
  const glm::dvec3 corners[] = {{0.0, -1.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  builder.add_polygon(corners);
  scenes::Camera camera;
  camera.from = {0.0F, 0.0F, 4.0F};
  camera.at = {0.0F, 0.0F, 0.0F};
  builder.add_camera(camera);
  const scenes::Scene scene = std::move(builder).build();
  const accel::PrimaryRays rays(camera, 33, 33, 1);
  const ReferenceHits reference(scene, rays);
  accel::HitBuffer buffer = traced("exhaustive", scene, rays);
  const auto change = [&](int y) {
    const std::size_t index = buffer.index(16, y, 0);
    const bool seen = reference.hits()[index].has_value();
    buffer.set(index, seen ? std::nullopt : std::optional(accel::Hit{4.0F, 0}));
  };
  change(15);
  change(16);
  EXPECT_EQ(
      verify_results(reference, buffer, accel::Conformance::kTolerance).count(DiffClass::kGraze),
      2U);
  EXPECT_EQ(verify_results(reference, buffer, accel::Conformance::kTolerance).verdict,
            Verdict::kOk);
  change(17);
  EXPECT_EQ(verify_results(reference, buffer, accel::Conformance::kTolerance).verdict,
            Verdict::kGrazes);
}

}  // namespace
}  // namespace beambench::verify

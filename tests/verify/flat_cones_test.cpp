// Cones of nearly zero height, down to rings: hits are correct, and verified as such.

#include <cmath>
#include <optional>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "harness/rays/ray_kind.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/verify/describe.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/verify/exact_answers.hpp"
#include "tests/verify/first_example.hpp"

namespace beambench::verify {
namespace {

using tests::first_example;

constexpr double kOuter = 2.0;
constexpr double kInner = 0.1;

scenes::Scene ring(double base_height, double height) {
  scenes::SceneBuilder builder("ring");
  builder.add_cone({0.0, base_height, 0.0}, kOuter, {0.0, base_height + height, 0.0}, kInner);
  scenes::Camera camera;
  camera.from = {0.3F, 2.0F, 0.5F};
  camera.at = {0.1F, 0.0F, 0.2F};
  camera.up = {0.0F, 0.0F, 1.0F};
  camera.angle = 90.0F;
  builder.add_camera(camera);
  return std::move(builder).build();
}

rays::TraceInput rays_over(const scenes::Scene& scene, const std::string& kind, int size) {
  return rays::make_trace_input(scene, {scene.cameras.front(), {size, size}, 1},
                                rays::parse_ray_choice(kind));
}

accel::HitBuffer traced(const std::string& structure, const scenes::Scene& scene,
                        const rays::TraceInput& input) {
  const auto built = accel::registry().choose(parse_spec(structure)).build(scene);
  rays::TraceResults results = rays::make_results(input);
  rays::trace(*built, input, results);
  return std::get<accel::HitBuffer>(std::move(results));
}

/// The expected hit of the ring that the cone resembles, to sufficient accuracy; `t` is empty if
/// the ray misses the ring. `unsure` is set if the ray passes within `margin` of a rim or is so
/// close to the ring's plane that the cone's height matters.
struct Expected {
  std::optional<double> t;
  bool unsure;
};
Expected expected_hit(const accel::Ray& ray, double height) {
  const double margin = 1e-5 + 2.0 * height;
  const glm::dvec3 direction(ray.direction);
  const double t = (0.5 * height - ray.origin.y) / direction.y;
  const glm::dvec3 point = glm::dvec3(ray.origin) + t * direction;
  const double distance = std::hypot(point.x, point.z);
  const double slant = std::abs(direction.y) / glm::length(direction);
  const bool near_rim = std::abs(distance - kOuter) * slant <= margin ||
                        std::abs(distance - kInner) * slant <= margin;
  const bool hits = t > 0.0 && kInner < distance && distance < kOuter;
  return {hits ? std::optional(t) : std::nullopt, near_rim || slant < 0.01};
}

class FlatCone : public ::testing::TestWithParam<double> {
 protected:
  double height() const { return GetParam(); }
  scenes::Scene scene_ = ring(0.0, GetParam());
};

TEST_P(FlatCone, IsHitLikeARing) {
  const double tolerance = 1e-5 + 2.0 * height();
  for (const std::string kind : {"primary", "random"}) {
    const rays::TraceInput input = rays_over(scene_, kind, 64);
    const ReferenceHits reference(scene_, input);
    const accel::HitBuffer found = traced("exhaustive", scene_, input);
    int hits = 0;
    for (std::size_t i = 0; i < input.size(); ++i) {
      const accel::Ray ray = input.ray(i);
      const Expected expected = expected_hit(ray, height());
      if (expected.unsure) continue;
      const auto check = [&](const char* who, const std::optional<double>& t) {
        ASSERT_EQ(t.has_value(), expected.t.has_value()) << who << " " << kind << " " << i;
        if (!t) return;
        ASSERT_NEAR(*t, *expected.t, tolerance * 100.0) << who << " " << kind << " " << i;
      };
      const auto structure = found.get(i);
      const auto oracle = reference.hits()[i];
      const auto exact = tests::exact_closest_hit(scene_, ray);
      check("exhaustive", structure ? std::optional<double>(structure->t) : std::nullopt);
      check("oracle", oracle ? std::optional(oracle->t) : std::nullopt);
      check("exact", exact ? std::optional(exact->t) : std::nullopt);
      hits += expected.t ? 1 : 0;
    }
    EXPECT_GT(hits, 300) << kind;
  }
}

TEST_P(FlatCone, IsVerified) {
  for (const std::string kind : {"primary", "random"}) {
    const rays::TraceInput input = rays_over(scene_, kind, 160);
    const ReferenceHits reference(scene_, input);
    for (const std::string structure :
         {"exhaustive", "samet", "voxel-grid", "sah-bvh", "kd-tree", "goldsmith-salmon",
          "hierarchical-grid", "beam", "grid-beam", "tile-beam", "embree"}) {
      const DiffReport report =
          verify_results(reference, traced(structure, scene_, input),
                         accel::registry().choose(parse_spec(structure)).info().conformance);
      EXPECT_EQ(report.verdict, Verdict::kOk) << structure << first_example(reference, report);
      EXPECT_EQ(report.count(DiffClass::kOracleError), 0U)
          << structure << first_example(reference, report);
      EXPECT_GT(report.hits, 2'000U);
    }
  }
}

TEST_P(FlatCone, HasNoRoomForErrors) {
  const rays::TraceInput input = rays_over(scene_, "primary", 40);
  const ReferenceHits reference(scene_, input);
  accel::HitBuffer buffer = traced("exhaustive", scene_, input);
  const auto expect_error = [&](std::size_t i, const std::optional<accel::Hit>& planted) {
    const auto before = buffer.get(i);
    buffer.set(i, planted);
    const DiffReport report = verify_results(reference, buffer, accel::Conformance::kTolerance);
    EXPECT_EQ(report.verdict, Verdict::kMismatch) << "ray " << i;
    EXPECT_EQ(report.count(DiffClass::kStructureError), 1U) << "ray " << i;
    buffer.set(i, before);
  };
  int on_ring = 0;
  int beside = 0;
  for (std::size_t i = 0; i < input.size(); i += 13) {
    const Expected expected = expected_hit(input.ray(i), height());
    if (expected.unsure) continue;
    if (expected.t) {
      const auto t = static_cast<float>(*expected.t);
      expect_error(i, std::nullopt);
      const float wrong = std::max(1e-4F, 10.0F * static_cast<float>(height()));
      expect_error(i, accel::Hit{t + wrong, 0});
      expect_error(i, accel::Hit{t - wrong, 0});
      ++on_ring;
    } else {
      // Invent a hit where the ray crosses the ring's plane, inside the hole or beyond the rim.
      const accel::Ray ray = input.ray(i);
      const double t = (0.5 * height() - ray.origin.y) / ray.direction.y;
      if (t > 0.0) expect_error(i, accel::Hit{static_cast<float>(t), 0});
      ++beside;
    }
  }
  EXPECT_GT(on_ring, 20);
  EXPECT_GT(beside, 5);
}

INSTANTIATE_TEST_SUITE_P(Heights, FlatCone,
                         ::testing::Values(1e-3, 1e-5, 1e-6, 1e-7, 1e-9, 1e-12, 1e-20, 1e-30));

TEST(FlatCones, IsVerifiedWhereRoundingOfTCrossesItsHeight) {
  const scenes::Scene scene = ring(0.5, 1e-6);
  const rays::TraceInput input = rays_over(scene, "random", 320);
  const ReferenceHits reference(scene, input);
  const DiffReport report =
      verify_results(reference, traced("exhaustive", scene, input), accel::Conformance::kBitExact);
  EXPECT_EQ(report.verdict, Verdict::kOk) << first_example(reference, report);
  EXPECT_EQ(report.count(DiffClass::kOracleError), 0U) << first_example(reference, report);
}

}  // namespace
}  // namespace beambench::verify

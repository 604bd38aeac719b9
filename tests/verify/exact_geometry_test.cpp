// The exact crossings and decisions of the judge's test, on configurations with known results.

#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "accel/exhaustive/exhaustive.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/random_scene.hpp"
#include "tests/verify/exact/acceptance.hpp"
#include "tests/verify/exact/claim_text.hpp"

namespace beambench::exact {
namespace {

constexpr float kLargest = std::numeric_limits<float>::max();

/// Returns a square of side 2 in y = 0 (primitive 0), a sphere of radius 1 around (0, 3, 0) (1), a
/// cone with its base of radius 1 in y = 5 and its apex at (0, 7, 0) (2), a sphere of radius 1
/// around (0, 9, 0) seen from the inside only (3).
scenes::Scene tower() {
  scenes::SceneBuilder builder("tower");
  const glm::dvec3 corners[] = {{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}};
  builder.add_polygon(corners);
  builder.add_sphere({0, 3, 0}, 1.0);
  builder.add_cone({0, 5, 0}, 1.0, {0, 7, 0}, 0.0);
  builder.add_sphere({0, 9, 0}, -1.0);
  return std::move(builder).build();
}

class ExactGeometry : public ::testing::Test {
 protected:
  static accel::Ray ray(glm::vec3 origin, glm::vec3 direction, float t_min = 0.0F,
                        float t_max = accel::kInfinity) {
    return {origin, t_min, direction, t_max};
  }
  Traced traced(const accel::Ray& of) const { return {solids_, of}; }
  bool right(const accel::Ray& of, const std::optional<accel::Hit>& claim) const {
    return Acceptance(traced(of), kStrict).accepts(claim);
  }
  bool wrong(const accel::Ray& of, const std::optional<accel::Hit>& claim) const {
    return !Acceptance(traced(of), kGenerous).accepts(claim);
  }
  /// Moves t by the tolerance K u at distance 1 from the coordinate origin.
  static float moved(float t, double units) {
    return static_cast<float>(t + units * 16.0 * 0x1p-24 * 8.0);
  }

  scenes::Scene scene_ = tower();
  std::vector<Solid> solids_ = solids_of(scene_);
};

TEST_F(ExactGeometry, AllSurfacesAreCrossedInOrder) {
  const Traced up = traced(ray({0.25F, -2.0F, 0.125F}, {0.0F, 4.0F, 0.0F}));
  ASSERT_EQ(up.crossings.size(), 5U);
  const double across = 0.25 * 0.25 + 0.125 * 0.125;
  const double sphere = std::sqrt(1.0 - across);
  const double expected[] = {2.0, 5.0 - sphere, 5.0 + sphere, 9.0 - 2.0 * std::sqrt(across),
                             11.0 + sphere};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_DOUBLE_EQ(up.ray.t_of(up.crossings[i].at.rounded()), expected[i] / 4.0) << i;
    EXPECT_TRUE(up.inside[i]);
  }
  EXPECT_FALSE(up.crossings[1].leaves);
  EXPECT_TRUE(up.crossings[2].leaves);
  EXPECT_TRUE(up.crossings[3].leaves) << "from inside the cone";
  EXPECT_EQ(up.crossings[4].primitive, 3U) << "where the ray leaves it";
}

TEST_F(ExactGeometry, OnARayAlongTheAxisTheApexIsMetTwice) {
  const Traced up = traced(ray({0.0F, 4.5F, 0.0F}, {0.0F, 1.0F, 0.0F}, 0.0F, 3.0F));
  int met = 0;
  for (std::size_t i = 0; i < up.crossings.size(); ++i) {
    if (!up.inside[i]) continue;
    ++met;
    EXPECT_EQ(compare(up.crossings[i].at, up.ray.parameter(2.5F)), 0);
  }
  EXPECT_EQ(met, 2);
}

TEST_F(ExactGeometry, IntervalUsesTheNearestFloat) {
  const float t = 1.0F / 3.0F;
  // The ray meets the square at exactly t = 1; one end of the interval is at this t or next to it.
  const glm::vec3 origin(0.25F, 1.0F, 0.125F);
  const glm::vec3 down(0.0F, -1.0F, 0.0F);
  const auto met = [&](float t_min, float t_max, glm::vec3 from, glm::vec3 along) {
    const Traced traced_ray = traced(ray(from, along, t_min, t_max));
    for (std::size_t i = 0; i < traced_ray.crossings.size(); ++i) {
      if (traced_ray.crossings[i].primitive == 0) return bool{traced_ray.inside[i]};
    }
    return false;
  };
  EXPECT_TRUE(met(0.0F, 1.0F, origin, down));
  EXPECT_FALSE(met(0.0F, std::nextafter(1.0F, 0.0F), origin, down));
  EXPECT_TRUE(met(1.0F, 2.0F, origin, down));
  EXPECT_FALSE(met(std::nextafter(1.0F, 2.0F), 2.0F, origin, down));
  // The ray meets the square at exactly t = 1/3, which rounds upward.
  EXPECT_TRUE(met(0.0F, t, origin, {0.0F, -3.0F, 0.0F}));
  EXPECT_TRUE(met(t, 1.0F, origin, {0.0F, -3.0F, 0.0F}));
  EXPECT_FALSE(met(0.0F, std::nextafter(t, 0.0F), origin, {0.0F, -3.0F, 0.0F}));
  // A t of half the smallest float rounds to zero, the even neighbor.
  EXPECT_TRUE(met(0.0F, 1.0F, {0.25F, 0x1p-149F, 0.125F}, {0.0F, 2.0F, 0.0F}));
  EXPECT_FALSE(met(0.0F, 1.0F, {0.25F, 0x1p-148F, 0.125F}, {0.0F, 2.0F, 0.0F}));
  // Beyond the largest float there are no hits.
  const glm::vec3 far(0.25F, 1e9F, 0.125F);
  EXPECT_TRUE(met(0.0F, accel::kInfinity, far, {0.0F, -3e-30F, 0.0F}));
  EXPECT_FALSE(met(0.0F, accel::kInfinity, far, {0.0F, -2e-30F, 0.0F}));
  EXPECT_EQ(rounding_to_at_most(accel::kInfinity).at,
            Number(kLargest) + Number(0x1p103));  // half a unit in the last place
}

TEST_F(ExactGeometry, ARayInThePlaneOfAPolygonDoesNotCrossIt) {
  const accel::Ray in_plane = ray({-3.0F, 0.0F, 0.125F}, {1.0F, 0.0F, 0.0F});
  EXPECT_TRUE(traced(in_plane).crossings.empty());
  EXPECT_TRUE(right(in_plane, std::nullopt));
  EXPECT_TRUE(right(in_plane, accel::Hit{2.0F, 0}));
  EXPECT_TRUE(right(in_plane, accel::Hit{3.0F, 0}));
  EXPECT_TRUE(wrong(in_plane, accel::Hit{1.0F, 0})) << "before the square";
}

TEST_F(ExactGeometry, MovedHitsAreCorrectWithinAQuarterAndWrongBeyondFour) {
  // At the square, |x| = 0.25 and |o| = 7.75, so u is 8 x 2^-24.
  const accel::Ray down = ray({0.25F, 7.746F, 0.0F}, {0.0F, -1.0F, 0.0F}, 5.75F);
  for (const double units : {-0.2, 0.0, 0.2}) {
    EXPECT_TRUE(right(down, accel::Hit{moved(7.746F, units), 0})) << units;
  }
  for (const double units : {-4.2, 4.2, 100.0}) {
    EXPECT_TRUE(wrong(down, accel::Hit{moved(7.746F, units), 0})) << units;
  }
  for (const double units : {-3.8, -0.4, 0.4, 3.8}) {
    EXPECT_FALSE(right(down, accel::Hit{moved(7.746F, units), 0})) << units;
    EXPECT_FALSE(wrong(down, accel::Hit{moved(7.746F, units), 0})) << units;
  }
}

// The surface of a flat cone, extended beyond its rim, stays close to the ray for a long distance.
TEST(ExactCones, APointOutsideTheRimOfAFlatConeIsWrong) {
  scenes::SceneBuilder builder("flat");
  builder.add_cone({-0.868675351, 0, 0.27275753}, 0.0488567129,
                   {-0.868675351, 7.11437388e-05, 0.27275753}, 0);
  const scenes::Scene scene = std::move(builder).build();
  const std::vector<Solid> solids = solids_of(scene);
  const auto right = [&](glm::vec3 aim, float t) {  // K u / 4 is 0.337 there
    const glm::vec3 origin(1e6F, 0.0F, 1e6F);
    return Acceptance(Traced(solids, {origin, 0.0F, aim - origin}), kStrict)
        .accepts(accel::Hit{t, 0});
  };
  EXPECT_FALSE(right({1.125F, 0.0F, -1.5625F}, std::nextafter(1.0F, 2.0F))) << "2.7 beside";
  EXPECT_FALSE(right({-0.868675351F, 0.5F, 0.27275753F}, 1.0F)) << "0.5 above";
  EXPECT_TRUE(right({-0.868675351F, 0.0F, 0.27275753F}, 1.0F)) << "through the base";
  EXPECT_TRUE(right({-0.868675351F, 0.25F, 0.25F}, 1.0F)) << "0.25 above the surface";
}

TEST_F(ExactGeometry, HitsBehindAClearHitAreWrong) {
  const accel::Ray down = ray({0.25F, 4.5F, 0.125F}, {0.0F, -1.0F, 0.0F});
  EXPECT_TRUE(wrong(down, accel::Hit{4.5F, 0}));
  EXPECT_TRUE(wrong(down, std::nullopt));
  EXPECT_TRUE(wrong(down, accel::Hit{0.5F, 1})) << "before the sphere";
  EXPECT_TRUE(wrong(down, accel::Hit{1.5F, 2})) << "the cone is behind the origin";
  const double first = 1.5 - std::sqrt(1.0 - 0.078125);
  const double second = 1.5 + std::sqrt(1.0 - 0.078125);
  EXPECT_TRUE(right(down, accel::Hit{static_cast<float>(first), 1}));
  EXPECT_TRUE(wrong(down, accel::Hit{static_cast<float>(second), 1}));
}

TEST_F(ExactGeometry, HitsBehindAGrazedHitAreJudgedAsUsual) {
  // The ray passes just outside the sphere's silhouette, then clearly through the square.
  const accel::Ray down = ray({1.0F, 4.5F, 0.0F}, {-0x1p-40F, -1.0F, 0.0F});
  EXPECT_TRUE(right(down, accel::Hit{4.5F, 0}));
  EXPECT_FALSE(wrong(down, accel::Hit{1.5F, 1}));
  const accel::Ray inward = ray({std::nextafter(1.0F, 0.0F), 4.5F, 0.0F}, {-0x1p-3F, -1.0F, 0.0F});
  EXPECT_TRUE(wrong(inward, std::nullopt));
}

TEST_F(ExactGeometry, ASphereSeenFromTheInsideIsHitWhereTheRayLeaves) {
  const accel::Ray down = ray({0.25F, 12.0F, 0.0F}, {0.0F, -1.0F, 0.0F}, 0.0F, 4.5F);
  const double half = std::sqrt(1.0 - 0.0625);
  EXPECT_TRUE(right(down, accel::Hit{static_cast<float>(3.0 + half), 3}));
  EXPECT_TRUE(wrong(down, accel::Hit{static_cast<float>(3.0 - half), 3}));
  EXPECT_TRUE(wrong(down, std::nullopt));
}

TEST_F(ExactGeometry, BoundariesAreFoundAtTheirDistance) {
  const auto near = [&](scenes::PrimitiveId id, double x, double within, Doubt doubt) {
    const accel::Ray down = ray({static_cast<float>(x), 20.0F, 0.0F}, {0.0F, -1.0F, 0.0F});
    return is_near_boundary(solids_[id], ExactRay(down), within, doubt);
  };
  for (const Doubt doubt : {Doubt::kFavors, Doubt::kOpposes}) {
    for (const scenes::PrimitiveId id : {0U, 1U, 2U, 3U}) {
      for (const double side : {-1.0, 1.0}) {
        const double at = 1.0 + side * 0x1p-12;
        EXPECT_TRUE(near(id, at, 0x1.1p-12, doubt)) << id << " " << side;
        EXPECT_FALSE(near(id, at, 0x1.ep-13, doubt)) << id << " " << side;
      }
    }
    EXPECT_FALSE(near(2, 0x1p-12, 0x1p-14, doubt)) << "the apex";
  }
  // Rays on both sides of an apex seen from above cross the cone in the same way.
  EXPECT_TRUE(near(2, 0x1p-12, 0x1.1p-12, Doubt::kFavors)) << "the apex";
  EXPECT_FALSE(near(2, 0x1p-12, 0x1.1p-12, Doubt::kOpposes)) << "the apex";
}

TEST_F(ExactGeometry, OcclusionIsDecidedByCrossingsAndGrazes) {
  const auto occlusion = [&](const accel::Ray& of, bool occluded) {
    const Traced about = traced(of);
    return std::array{Acceptance(about, kStrict).accepts_occlusion(occluded),
                      Acceptance(about, kGenerous).accepts_occlusion(occluded)};
  };
  constexpr std::array kRight{true, true};
  constexpr std::array kWrong{false, false};
  const accel::Ray through = ray({0.25F, 2.0F, 0.125F}, {0.0F, -1.0F, 0.0F}, 0.0F, 1.5F);
  EXPECT_EQ(occlusion(through, false), kRight) << "it ends before the square";
  EXPECT_EQ(occlusion(through, true), kWrong);
  const accel::Ray touching = ray({0.25F, 1.5F, 0.125F}, {0.0F, -1.0F, 0.0F}, 0.0F, 1.5F);
  EXPECT_EQ(occlusion(touching, false), kRight) << "it ends on the square";
  EXPECT_EQ(occlusion(touching, true), kRight);
  const accel::Ray ending =
      ray({0.25F, 1.5F, 0.125F}, {0.0F, -1.0F, 0.0F}, 0.0F, std::nextafter(1.5F, 0.0F));
  EXPECT_EQ(occlusion(ending, false), kRight) << "it ends just before the square";
  EXPECT_EQ(occlusion(ending, true), kRight);
  const accel::Ray beside =
      ray({std::nextafter(1.0F, 2.0F), 1.5F, 0.125F}, {0.0F, -1.0F, 0.0F}, 0.0F, 1.75F);
  EXPECT_EQ(occlusion(beside, false), kRight) << "it passes an edge";
  EXPECT_EQ(occlusion(beside, true), kRight);
}

TEST(ExactCrossings, FirstOneIsTheHitOfExhaustiveInGeneralPosition) {
  int hits = 0;
  for (std::uint64_t seed = 1; seed < 40; seed += 4) {  // neither snapped, repeated nor remote
    const scenes::Scene scene = tests::random_scene(4 * seed + 3, 8);
    const std::vector<Solid> solids = solids_of(scene);
    const accel::exhaustive::Exhaustive exhaustive(scene);
    Random random(seed);
    for (int i = 0; i < 200; ++i) {
      const accel::Ray ray = tests::random_ray(scene, random);
      const Traced traced(solids, ray);
      const auto hit = exhaustive.closest_hit(ray, nullptr);
      if (std::ranges::any_of(solids, [&](const Solid& solid) {
            return is_near_boundary(solid, traced.ray, 1e-4, Doubt::kFavors);
          })) {
        continue;
      }
      const auto first = std::ranges::find(traced.inside, true) - traced.inside.begin();
      const bool any = first < std::ssize(traced.inside);
      ASSERT_EQ(hit.has_value(), any) << "seed " << seed << ", ray " << i << "\n"
                                      << text_of(scene, traced);
      if (!hit) continue;
      ++hits;
      const Crossing& crossing = traced.crossings[static_cast<std::size_t>(first)];
      EXPECT_EQ(hit->primitive, crossing.primitive) << "seed " << seed << ", ray " << i;
      const double t = traced.ray.t_of(crossing.at.rounded());
      EXPECT_NEAR(hit->t, t, 1e-7 * (1.0 + t)) << "seed " << seed << ", ray " << i;
      EXPECT_TRUE(Acceptance(traced, kStrict).accepts(hit)) << "seed " << seed << ", ray " << i;
    }
  }
  EXPECT_GT(hits, 300);
}

}  // namespace
}  // namespace beambench::exact

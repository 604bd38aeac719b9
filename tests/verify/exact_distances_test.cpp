// The distances used by the judge's test, compared with doubles and with trials.

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "harness/verify/selftest/test_scenes.hpp"
#include "scenes/base/random.hpp"
#include "tests/verify/exact/boundary.hpp"
#include "tests/verify/exact/claim_rays.hpp"
#include "tests/verify/exact/claim_scenes.hpp"

namespace beambench::exact {
namespace {

/// Returns the unit normal of a surface at one of its points, in double; nothing at the apex of a
/// cone.
std::optional<glm::dvec3> normal_at(const Solid& solid, const glm::dvec3& x) {
  if (const auto* sphere = std::get_if<Sphere>(&solid.shape)) {
    return glm::normalize(x - sphere->center.rounded());
  }
  if (const auto* cone = std::get_if<Cone>(&solid.shape)) {
    const glm::dvec3 axis = cone->axis.rounded();
    const glm::dvec3 offset = x - cone->base.rounded();
    const double length = glm::length(axis);
    const glm::dvec3 across = offset - glm::dot(offset, axis) / (length * length) * axis;
    if (glm::length(across) < 1e-6) return std::nullopt;
    // Perpendicular to the slanted line: (length, -taper) in (across, along the axis).
    return glm::normalize(length * glm::normalize(across) - cone->taper.rounded() * axis / length);
  }
  return glm::normalize(std::get<Polygon>(solid.shape).triangles.front().normal.rounded());
}

TEST(ExactDistances, AcrossASurfaceTheyAreMeasuredAlongItsNormal) {
  int compared = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    const scenes::Scene scene = room(random);
    const std::vector<Solid> solids = solids_of(scene);
    for (int i = 0; i < 20; ++i) {
      const ExactRay ray(claim_ray(scene, solids, {.start = RayStyle::Start::kAround}, random));
      for (const Crossing& crossing : crossings_of(solids, ray)) {
        const double s = crossing.at.rounded();
        const auto normal = normal_at(solids[crossing.primitive], ray.at(s));
        if (!normal) continue;
        const double outward = glm::dot(*normal, ray.direction.rounded());
        const double cosine = std::abs(outward) / ray.speed;
        if (cosine < 1e-3 || std::abs(s) > 1e3) continue;
        for (const double step : {-0x1p-10, 0x1p-10}) {
          const Number moved = Number(s) + Number(step);
          const double across = std::abs(step) * ray.speed * cosine;
          EXPECT_TRUE(crossing.is_across(moved, 1.0001 * across)) << "seed " << seed;
          EXPECT_FALSE(crossing.is_across(moved, 0.9999 * across)) << "seed " << seed;
          EXPECT_TRUE(crossing.is_along(moved, 1.0001 * std::abs(step)));
          EXPECT_FALSE(crossing.is_along(moved, 0.9999 * std::abs(step)));
          ++compared;
        }
        if (crossing.curved) {
          EXPECT_EQ(crossing.leaves, outward > 0.0);
        }
      }
    }
  }
  EXPECT_GT(compared, 1000);
}

/// Returns whether any of many rays shifted by up to `within` crosses the cone differently.
bool is_near_by_trial(const Cone& cone, const ExactRay& ray, double within, Random& random) {
  const std::array<int, 2> here = crossing_counts(cone, ray);
  for (int i = 0; i < 40; ++i) {
    ExactRay shifted = ray;
    const glm::dvec3 across =
        glm::normalize(glm::cross(ray.direction.rounded(), unit_vector(random)));
    shifted.origin = ray.origin + Vector(within * std::sqrt(random.unit()) * across);
    if (crossing_counts(cone, shifted) != here) return true;
  }
  return false;
}

TEST(ExactDistances, ConesHaveNoBoundaryWhereItIsExcluded) {
  int far = 0;
  int near = 0;
  int open = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    Modeller modeller("cone", 0);
    modeller.add_cone(verify::point_in_cube(random), random.uniform(0.2, 1.0),
                      2.0 * verify::point_in_cube(random),
                      random.below(3) == 0 ? 0.0 : random.uniform(0.2, 1.0));
    const scenes::Scene scene = std::move(modeller).build();
    const std::vector<Solid> solids = solids_of(scene);
    const Cone& cone = std::get<Cone>(solids.front().shape);
    for (int i = 0; i < 10; ++i) {
      const ExactRay ray(claim_ray(scene, solids, {.start = RayStyle::Start::kAround}, random));
      const double within = log_uniform(-22, -6, random);
      const bool ruled_out = !is_near_boundary(cone, ray, within, Doubt::kFavors);
      const bool proven = is_near_boundary(cone, ray, within, Doubt::kOpposes);
      ASSERT_FALSE(ruled_out && proven) << "seed " << seed << ", ray " << i;
      if (ruled_out) {
        ++far;
        ASSERT_FALSE(is_near_by_trial(cone, ray, within, random))
            << "seed " << seed << ", ray " << i;
      } else if (is_near_boundary(cone, ray, 4.0 * within, Doubt::kOpposes)) {
        ++near;
      } else {
        ++open;
      }
    }
  }
  EXPECT_GT(far, 200);
  EXPECT_GT(near, 200);
  EXPECT_LT(open, 50) << "neither ruled out nor proven within four times the distance";
}

}  // namespace
}  // namespace beambench::exact

// Objects kept outside the octree: hits, counts and paths are those of the whole scene.

#include "accel/octree/outside_list.hpp"

#include <cstddef>
#include <cstdint>

#include <gtest/gtest.h>

#include "accel/exhaustive/exhaustive.hpp"
#include "accel/octree/samet.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel::octree {
namespace {

using Outside = WithOutsideList<Samet>;

TEST(OutsideList, LosesNoHitForAnyObjectsOutside) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 25);
    const exhaustive::Exhaustive exhaustive(scene);
    Random random(seed);
    for (const double largest : {1e-6, 0.05, 0.3, 1.0}) {
      const Outside structure(scene, {}, largest, {});
      for (int i = 0; i < 60; ++i) {
        const Ray ray = tests::random_ray(scene, random);
        const auto hit = exhaustive.closest_hit(ray, nullptr);
        ASSERT_EQ(structure.closest_hit(ray, nullptr), hit) << largest;
        ASSERT_EQ(structure.any_hit(ray, nullptr), hit.has_value()) << largest;
      }
    }
  }
}

TEST(OutsideList, DividesTheScenesSmallObjectsMoreFinely) {
  const scenes::Scene scene = scenes::load_scene("gato-bill");
  const InsideAndOutside ids(scene, 0.5);
  ASSERT_EQ(ids.outside.size(), 1U) << "the floor";
  const Outside structure(scene, {}, 0.5, {});
  const Samet whole(scene, {});
  EXPECT_LT(structure.inner().octree().grid().cell.x, 0.7 * whole.octree().grid().cell.x);
}

TEST(OutsideList, RecordsThePrimitivesOfTheWholeScene) {
  const scenes::Scene scene = scenes::load_scene("escena2");
  const Outside structure(scene, {}, 0.5, {});
  ASSERT_FALSE(InsideAndOutside(scene, 0.5).outside.empty());
  const PrimaryRays rays(scene.cameras.front(), 64, 48, 1);
  for (int y = 0; y < rays.height(); ++y) {
    for (int x = 0; x < rays.width(); ++x) {
      const Ray ray = rays.ray(x, y, 0);
      const auto hit = structure.closest_hit(ray, nullptr);
      bool found = !hit.has_value();
      for (const TraceStep& step : structure.path(ray)) {
        for (const TestedPrimitive& test : step.tests) {
          found = found || (test.primitive == hit->primitive && test.t == hit->t);
        }
      }
      ASSERT_TRUE(found);
    }
  }
}

}  // namespace
}  // namespace beambench::accel::octree

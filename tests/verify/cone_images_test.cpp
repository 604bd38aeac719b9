// tile-beam's images of cones of every shape, from all viewpoints, checked by the differ on every
// instruction set; and how rarely they need the canonical test.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "accel/tile_beam/tile_beam.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/verify/describe.hpp"
#include "harness/verify/differ.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/only_target.hpp"
#include "tests/random_scene.hpp"
#include "tests/random_view.hpp"

namespace beambench::verify {
namespace {

using glm::dvec3;
using tests::random_direction;

/// Returns 10 to a random power.
double magnitude(Random& random, double lowest, double highest) {
  return std::pow(10.0, random.uniform(lowest, highest));
}

/// The shape of a cone whose length is about 1.
struct Shape {
  const char* name;
  double (*length)(Random&);
  double (*base_radius)(Random&);
  double (*apex_radius)(Random&, double base_radius);
};

double some(Random& random) { return random.uniform(0.1, 1.0); }
double same(Random&, double base_radius) { return base_radius; }

const std::vector<Shape>& shapes() {
  static const std::vector<Shape> kShapes{
      {"frustums", some, some, [](Random& random, double) { return some(random); }},
      {"cylinders", some, some, same},
      {"cones with a tip", some, some, [](Random&, double) { return 0.0; }},
      {"cones with the tip at the base", some, [](Random&) { return 0.0; },
       [](Random& random, double) { return some(random); }},
      {"needles", some, [](Random& random) { return magnitude(random, -7.0, -2.0); },
       [](Random& random, double radius) { return radius * random.unit(); }},
      {"flat cones", [](Random& random) { return magnitude(random, -9.0, -1.0); }, some,
       [](Random& random, double radius) { return radius * random.unit(); }},
      {"rings", [](Random& random) { return magnitude(random, -7.0, -1.0); }, some, same},
      {"nearly cylinders", some, some,
       [](Random& random, double radius) {
         return radius * (1.0 + magnitude(random, -7.0, -2.0));
       }},
  };
  return kShapes;
}

/// Returns a few cones of one shape around a place, some of them visible only from the inside.
scenes::Scene cones_of(const Shape& shape, double scale, const dvec3& place, Random& random) {
  scenes::SceneBuilder builder("cones");
  const auto count = 1 + random.below(8);
  for (std::uint64_t i = 0; i < count; ++i) {
    const dvec3 base = place + scale * point_in_cube(random);
    const double length = shape.length(random);
    const double radius = shape.base_radius(random);
    const double apex_radius = shape.apex_radius(random, radius);
    const double sign = random.below(5) == 0 ? -scale : scale;
    try {
      builder.add_cone(base, sign * radius, base + scale * length * random_direction(random),
                       sign * apex_radius);
    } catch (const InputError&) {  // far from the origin, a flat cone may have no height in float
    }
  }
  builder.add_sphere(place, 0.3 * scale);
  return std::move(builder).build();
}

/// The eye and its target.
using View = std::pair<dvec3, dvec3>;

/// Returns views in which cones are difficult: from eyes on the axis inside and beyond the cone,
/// close to the axis, on and next to the surface, on its extension, at its extended tip, and far
/// away.
std::vector<View> views_of(const scenes::Cone& cone, Random& random) {
  const dvec3 base(cone.base);
  const dvec3 axis = dvec3(cone.apex) - base;
  const dvec3 side = glm::normalize(glm::cross(axis, random_direction(random)));
  const double taper = static_cast<double>(cone.apex_radius) - cone.base_radius;
  const auto on_surface = [&](double along) {
    return base + along * axis + (cone.base_radius + along * taper) * side;
  };
  const double size = glm::length(axis) + std::max(cone.base_radius, cone.apex_radius);
  const dvec3 middle = base + 0.5 * axis;
  const dvec3 anywhere = middle + size * random_direction(random);
  std::vector<View> views{{middle, anywhere},
                          {base + 0.9 * axis, base},
                          {base + 3.0 * axis, base},
                          {base + 3.0 * axis + 1e-4 * size * side, base},
                          {on_surface(2.0), on_surface(0.5)},
                          {on_surface(-2.0), on_surface(0.5)},
                          {on_surface(0.5), anywhere},
                          {middle + 100.0 * size * random_direction(random), middle}};
  if (taper != 0.0 && cone.base_radius > 0.0F && cone.apex_radius > 0.0F) {
    views.emplace_back(base - axis * (cone.base_radius / taper), middle);
  }
  for (const double near : {1e-2, 1e-4, 1e-6}) {
    views.emplace_back(on_surface(0.3) + near * size * side, anywhere);
    views.emplace_back(on_surface(0.3) - near * size * side, anywhere);
  }
  return views;
}

/// Counts summed over many images.
struct Tally {
  std::uint64_t rays = 0;
  std::uint64_t hits = 0;
  std::uint64_t grazes = 0;
};

/// Expects the image of a scene to be right.
void expect_right(const scenes::Scene& scene, const scenes::Camera& camera, Tally& tally) {
  const accel::tile_beam::TileBeam structure(scene, {});
  const rays::TraceInput input(accel::PrimaryRays(camera, 45, 31, 1));
  rays::TraceResults found = rays::make_results(input);
  rays::poison(found);
  rays::trace(structure, input, found);
  const ReferenceHits reference(scene, input);
  const DiffReport report = verify_results(reference, found, accel::Conformance::kTolerance);
  tally.rays += report.rays;
  tally.hits += report.hits;
  tally.grazes += report.count(DiffClass::kGraze);
  EXPECT_EQ(report.count(DiffClass::kStructureError), 0U)
      << describe(scene, report.examples.front());
  EXPECT_EQ(report.count(DiffClass::kOracleError), 0U) << describe(scene, report.examples.front());
}

scenes::Camera camera_of(const View& view, Random& random) {
  scenes::Camera camera;
  camera.from = glm::vec3(view.first);
  camera.at = glm::vec3(view.second);
  camera.up = glm::vec3(random_direction(random));
  camera.angle = static_cast<float>(random.uniform(20.0, 120.0));
  return camera;
}

bool is_possible(const scenes::Camera& camera) {
  const dvec3 view = dvec3(camera.at) - dvec3(camera.from);
  return glm::length(glm::cross(view, dvec3(camera.up))) > 1e-3 * glm::length(view);
}

class ConeImages : public ::testing::TestWithParam<std::size_t> {};

TEST_P(ConeImages, AreCorrectFromEverywhere) {
  const Shape& shape = shapes()[GetParam()];
  Tally tally;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const tests::OnlyTarget only(target);
    for (std::uint64_t seed = 1; seed <= 12 && !HasFailure(); ++seed) {
      SCOPED_TRACE(seed);
      Random random(seed);
      const double scale = seed % 3 == 0 ? magnitude(random, -8.0, 6.0) : 1.0;
      const dvec3 place = seed % 4 == 0 ? 30.0 * scale * point_in_cube(random) : dvec3(0.0);
      const scenes::Scene scene = cones_of(shape, scale, place, random);
      for (int i = 0; i < 4; ++i) {
        const scenes::Camera view = tests::random_view(scene, random);
        const scenes::Camera camera = camera_of({view.from, view.at}, random);
        if (is_possible(camera)) expect_right(scene, camera, tally);
      }
      if (scene.cones.empty()) continue;
      for (const View& view : views_of(scene.cones.front(), random)) {
        const scenes::Camera camera = camera_of(view, random);
        if (is_possible(camera)) expect_right(scene, camera, tally);
      }
    }
  }
  EXPECT_GT(tally.hits, tally.rays / 50);
  EXPECT_LT(tally.grazes, tally.rays / 10000);
}

INSTANTIATE_TEST_SUITE_P(Shapes, ConeImages, ::testing::Range(std::size_t{0}, shapes().size()),
                         [](const auto& info) {
                           std::string name = shapes()[info.param].name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

/// Nearly all samples must be decided in float, because the canonical test takes fifty times as
/// long.
TEST(ConeImages, AreRarelyDoubtful) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const tests::OnlyTarget only(target);
    for (const char* name : {"rings:n=2", "tree:n=5", "lattice:n=3", "jacks"}) {
      const scenes::Scene scene = scenes::load_scene(name);
      const accel::tile_beam::TileBeam structure(scene, {});
      const accel::PrimaryRays rays(scene.cameras.front(), 300, 300, 1);
      accel::HitBuffer image(300, 300, 1);
      accel::WorkCounters counters;
      structure.closest_hits(rays, image, {&counters});
      EXPECT_GT(counters.by_name()["cone_tests"], 0U) << name;
      EXPECT_LT(counters.by_name()["doubtful_samples"], image.size() / 400) << name;
    }
  }
}

}  // namespace
}  // namespace beambench::verify

// Closed meshes do not leak light: pencils stop each shadow ray between inside and outside.

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "accel/tile_beam/tile_beam.hpp"
#include "harness/rays/ray_set.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/closed_bodies.hpp"
#include "tests/only_target.hpp"
#include "tests/random_scene.hpp"

namespace beambench::verify {
namespace {

using accel::tile_beam::TileBeam;
using glm::dvec3;
using scenes::modelling::PolygonMesh;
using tests::bodies;
using tests::Body;
using tests::direction_from;
using tests::Placement;

/// Rays between a light and points, one of which is inside a body and the other outside.
class Sealed {
 public:
  Sealed(const Body& body, std::uint64_t seed)
      : body_(&body), random_(seed), placement_(random_), scene_(placed()) {}

  static constexpr std::size_t kRays = TileBeam::least_pencil(true);
  /// The places through which half of the rays toward a light inside pass; the others are random.
  enum class Aim { kNearEdges, kAtEdgesAndCorners };

  const scenes::Scene& scene() const { return scene_; }

  rays::RayList rays(bool light_inside, Aim aim) {
    const dvec3 light = light_inside ? inside() : outside();
    const glm::vec3 apex(placement_(light));
    rays::RayList list;
    for (std::size_t i = 0; i < kRays; ++i) {
      const dvec3 point = !light_inside ? inside()
                          : i % 2 == 0
                              ? outside()
                              : beyond(aim == Aim::kNearEdges ? near_edge() : on_edge(), light);
      accel::Ray ray;
      ray.origin = glm::vec3(placement_(point));
      ray.direction = apex - ray.origin;
      ray.t_max = 1.0F;
      list.rays.push_back(ray);
    }
    list.pencils.push_back({0, list.rays.size(), dvec3(apex), true});
    return list;
  }

 private:
  scenes::Scene placed() const {
    PolygonMesh mesh = body_->mesh;
    for (dvec3& vertex : mesh.vertices) vertex = placement_(vertex);
    scenes::SceneBuilder builder(body_->name);
    scenes::modelling::add_flat(builder, mesh);
    return std::move(builder).build();
  }

  dvec3 inside() {
    const dvec3& middle = body_->middles[random_.below(body_->middles.size())];
    if (random_.below(8) == 0) return middle;
    return middle + body_->clearance * random_.unit() * direction_from(random_);
  }
  dvec3 outside() { return random_.uniform(1.05, 4.0) * body_->reach * direction_from(random_); }

  /// Returns a corner of the mesh or a place between two of them.
  dvec3 on_edge() {
    const PolygonMesh::Corners& corners =
        body_->mesh.polygons[random_.below(body_->mesh.polygons.size())];
    const std::uint64_t first = random_.below(3);
    const dvec3& a = body_->mesh.vertices[corners[first]];
    const dvec3& b = body_->mesh.vertices[corners[(first + 1) % 3]];
    return random_.below(3) == 0 ? a : a + random_.unit() * (b - a);
  }
  /// Returns a place within a few dozen roundings of an edge.
  dvec3 near_edge() { return on_edge() + 4e-6 * body_->reach * point_in_cube(random_); }
  /// Returns a place outside, from which `place` hides the light inside.
  dvec3 beyond(const dvec3& place, const dvec3& light) const {
    return light + 2.1 * body_->reach * glm::normalize(place - light);
  }

  const Body* body_;
  Random random_;
  Placement placement_;
  scenes::Scene scene_;
};

/// Checks `placements` random placements, with the light alternately inside and outside.
void expect_no_leak(std::uint64_t placements, Sealed::Aim aim = Sealed::Aim::kNearEdges) {
  const std::vector<Body> all = bodies();
  std::vector<std::uint8_t> hits(Sealed::kRays);
  std::uint64_t most_sides = 0;
  std::uint64_t leaking = 0;
  for (std::uint64_t i = 0; i < placements && leaking < 10; ++i) {
    const Body& body = all[i % all.size()];
    const bool light_inside = i / all.size() % 2 == 0;
    Sealed sealed(body, i);
    const TileBeam structure(sealed.scene(), {});
    const rays::RayList list = sealed.rays(light_inside, aim);
    std::ranges::fill(hits, std::uint8_t{9});
    structure.any_hits(list.batch(), hits, {});
    const auto stopped = static_cast<std::size_t>(std::ranges::count(hits, 1));
    if (stopped != Sealed::kRays) {
      ++leaking;
      ADD_FAILURE() << body.name << ", placement " << i << ": " << Sealed::kRays - stopped
                    << " rays leak, the first is "
                    << std::ranges::find_if(hits, [](auto hit) { return hit != 1; }) - hits.begin();
    }
    if (i % 64 == 0) {
      accel::WorkCounters counters;
      structure.any_hits(list.batch(), hits, {&counters});
      const auto work = counters.by_name();
      ASSERT_TRUE(work.contains("beams")) << "these rays are too few for a pencil";
      most_sides = std::max(most_sides, work.at("beams"));
    }
  }
  EXPECT_EQ(most_sides, 6U);
}

TEST(ClosedMeshes, LeakNoLightInTenThousandPlacements) { expect_no_leak(10'000); }

TEST(ClosedMeshes, LeakNoLightOnAnyInstructionSet) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const tests::OnlyTarget only(target);
    expect_no_leak(500);
  }
}

/// Along common edges, each triangle must stop the rays that the others let pass.
TEST(ClosedMeshes, LeakNoLightAtEdgesAndCorners) {
  expect_no_leak(10'000, Sealed::Aim::kAtEdgesAndCorners);
}

/// Uses so many rays that pencils have several parts, and so many triangles that these are small.
TEST(ClosedMeshes, LeakNoLightInLargePencils) {
  for (const char* name : {"bumpy:triangles=3072", "bumpy:triangles=48"}) {
    const scenes::Scene scene = scenes::load_scene(name);
    const TileBeam structure(scene, {});
    Random random(5);
    for (int placement = 0; placement < 8; ++placement) {
      // The mesh lies between these spheres about the origin.
      constexpr double kInside = 0.3;
      constexpr double kOutside = 2.0;
      const bool light_inside = placement % 2 == 0;
      const glm::vec3 light(direction_from(random) *
                            (light_inside ? kInside * random.unit() : kOutside + random.unit()));
      rays::RayList list;
      for (int i = 0; i < 9000; ++i) {
        accel::Ray ray;
        ray.origin = glm::vec3(direction_from(random) *
                               (light_inside ? kOutside + random.unit() : kInside * random.unit()));
        ray.direction = light - ray.origin;
        ray.t_max = 1.0F;
        list.rays.push_back(ray);
      }
      list.pencils.push_back({0, list.rays.size(), dvec3(light), true});
      std::vector<std::uint8_t> hits(list.rays.size(), 9);
      structure.any_hits(list.batch(), hits, {});
      EXPECT_EQ(std::ranges::count(hits, 1), 9000) << name << " placement " << placement;
    }
  }
}

}  // namespace
}  // namespace beambench::verify

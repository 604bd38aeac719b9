// tile-beam culls the backs of closed surfaces: no image may reveal it.

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
#include "harness/verify/describe.hpp"
#include "harness/verify/differ.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/closed_bodies.hpp"
#include "tests/number_from.hpp"
#include "tests/only_target.hpp"

namespace beambench::verify {
namespace {

using accel::PrimaryRays;
using accel::tile_beam::TileBeam;
using accel::tile_beam::TileHierarchyOptions;
using glm::dvec3;
using scenes::modelling::PolygonMesh;
using tests::Body;
using tests::direction_from;
using tests::Placement;

void turn_inside_out(PolygonMesh& mesh) {
  for (auto& corners : mesh.polygons) std::ranges::reverse(corners);
}

/// One to four bodies: apart, overlapping, nested, touching, mirrored, inside out, or with a hole.
class Exhibit {
 public:
  Exhibit(const std::vector<Body>& bodies, std::uint64_t seed) : random_(seed) {
    scenes::SceneBuilder builder("exhibit");
    const Placement whole(random_);
    const std::uint64_t count = 1 + random_.below(4);
    for (std::uint64_t i = 0; i < count; ++i) {
      PolygonMesh mesh = bodies[random_.below(bodies.size())].mesh;
      vary(mesh, i);
      for (dvec3& vertex : mesh.vertices) vertex = whole(vertex);
      scenes::modelling::add_flat(builder, mesh);
    }
    scene_ = std::move(builder).build();
  }

  const scenes::Scene& scene() const { return scene_; }

  /// Returns a view whose eye is anywhere around, near the center, on a surface or slightly off it.
  PrimaryRays view() {
    const double extent = glm::length(dvec3(scene_.bounds.extent()));
    scenes::Camera camera;
    camera.from = glm::vec3(eye(extent));
    const dvec3 to = random_.below(3) == 0 ? dvec3(camera.from) + extent * direction_from(random_)
                                           : on_surface().first;
    camera.at = glm::vec3(to);
    if (glm::length(camera.at - camera.from) < 1e-5 * extent) {
      camera.at = camera.from + static_cast<float>(extent) * glm::vec3(direction_from(random_));
    }
    const glm::vec3 along = glm::normalize(camera.at - camera.from);
    camera.up =
        std::abs(along.x) < 0.7F ? glm::vec3(1.0F, 0.0F, 0.0F) : glm::vec3(0.0F, 1.0F, 0.0F);
    camera.angle = static_cast<float>(random_.uniform(10.0, 120.0));
    const PrimaryRays rays(camera, 19, 13, 1);
    return random_.below(4) == 0
               ? rays.mirrored(dvec3(camera.from) + 0.01 * extent * direction_from(random_),
                               direction_from(random_))
               : rays;
  }

 private:
  void vary(PolygonMesh& mesh, std::uint64_t number) {
    dvec3 shift(0.0);
    double scale = 1.0;
    switch (random_.below(4)) {
      case 0:  // inside the previous body, or around it
        scale = random_.uniform(0.1, 2.0);
        break;
      case 1:  // a box's neighbor
        shift[static_cast<int>(random_.below(3))] = 2.0 * static_cast<double>(number);
        break;
      case 2:
        shift = 1.5 * point_in_cube(random_);
        break;
      default:
        shift = 6.0 * point_in_cube(random_);
        break;
    }
    const bool mirrored = random_.below(4) == 0;
    for (dvec3& vertex : mesh.vertices) {
      if (mirrored) vertex.x = -vertex.x;
      vertex = shift + scale * vertex;
    }
    if (random_.below(4) == 0) turn_inside_out(mesh);
    if (random_.below(6) == 0) mesh.polygons.pop_back();
  }

  /// Returns a place on a triangle, sometimes on its edge or corner, and the triangle's normal.
  std::pair<dvec3, dvec3> on_surface() {
    const scenes::Triangle& triangle = scene_.triangles[random_.below(scene_.triangles.size())];
    const auto corner = [&](std::size_t i) { return dvec3(scene_.vertices[triangle.vertex[i]]); };
    double u = random_.below(4) == 0 ? 0.0 : random_.unit();
    double v = random_.below(4) == 0 ? 0.0 : random_.unit();
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const dvec3 a = corner(1) - corner(0);
    const dvec3 b = corner(2) - corner(0);
    return {corner(0) + u * a + v * b, glm::normalize(glm::cross(a, b))};
  }

  dvec3 eye(double extent) {
    const dvec3 middle = 0.5 * (dvec3(scene_.bounds.lower) + dvec3(scene_.bounds.upper));
    switch (random_.below(4)) {
      case 0:
        return middle + random_.uniform(0.0, 2.0) * extent * direction_from(random_);
      case 1:
        return middle + 0.3 * extent * point_in_cube(random_);
      case 2:
        return on_surface().first;
      default: {
        const auto [place, normal] = on_surface();
        const double beside = std::pow(10.0, random_.uniform(-7.0, -1.0)) * extent;
        return place + (random_.below(2) == 0 ? beside : -beside) * normal;
      }
    }
  }

  Random random_;
  scenes::Scene scene_;
};

struct Found {
  std::uint64_t rays = 0;
  std::uint64_t errors = 0;
  std::uint64_t grazes = 0;
  std::string first;
};

void add(Found& found, const scenes::Scene& scene, const TileBeam& structure,
         const ReferenceHits& reference, const PrimaryRays& rays, std::uint64_t seed) {
  accel::HitBuffer image(rays.width(), rays.height(), 1);
  structure.closest_hits(rays, image, {});
  const DiffReport report =
      verify_results(reference, std::move(image), accel::Conformance::kTolerance);
  found.rays += report.rays;
  found.grazes += report.count(DiffClass::kGraze);
  found.errors += report.count(DiffClass::kStructureError);
  if (report.count(DiffClass::kStructureError) > 0 && found.first.empty()) {
    found.first = "seed " + std::to_string(seed) + ": " +
                  describe(scene, reference.input(), report.examples.front());
  }
}

/// Checks 25 views of each of `exhibits` scenes.
void expect_right_views(std::uint64_t exhibits) {
  constexpr int kViews = 25;
  const std::vector<Body> bodies = tests::bodies();
  Found culled;
  Found whole;
  std::size_t solids = 0;
  for (std::uint64_t seed = 1; seed <= exhibits; ++seed) {
    Exhibit exhibit(bodies, seed);
    const scenes::Scene& scene = exhibit.scene();
    const TileBeam culling(scene, {.backface_culling = true});
    const TileBeam drawing_all(scene, {.backface_culling = false});
    solids += culling.hierarchy().solids.solids.size();
    EXPECT_TRUE(drawing_all.hierarchy().solids.solids.empty());
    for (int view = 0; view < kViews; ++view) {
      const PrimaryRays rays = exhibit.view();
      const ReferenceHits reference(scene, rays);
      add(culled, scene, culling, reference, rays, seed);
      add(whole, scene, drawing_all, reference, rays, seed);
    }
  }
  EXPECT_GT(solids, exhibits);  // otherwise nothing was tested
  EXPECT_EQ(culled.errors, 0U) << culled.first;
  EXPECT_EQ(whole.errors, 0U) << whole.first;
  // At silhouettes, rounding may let a sample between two triangles show either side.
  EXPECT_LE(culled.grazes, whole.grazes + culled.rays / 100'000 + 2);
}

// In full, ten thousand views.
TEST(BackfaceCulling, IsInvisibleInEveryView) { expect_right_views(tests::in_full(400, 120)); }

TEST(BackfaceCulling, IsInvisibleOnEveryInstructionSet) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const tests::OnlyTarget only(target);
    expect_right_views(20);
  }
}

TEST(BackfaceCulling, LeavesOutNodesThatAreTurnedAway) {
  const scenes::Scene scene = scenes::load_scene("bumpy:triangles=50700");
  const PrimaryRays rays(scene.cameras.front(), 320, 200, 1);
  const auto leaves = [&](bool culling) {
    accel::HitBuffer image(320, 200, 1);
    accel::WorkCounters counters;
    TileBeam(scene, {.backface_culling = culling}).closest_hits(rays, image, {&counters});
    return counters.get(accel::Counter::kLeaves);
  };
  EXPECT_LT(10 * leaves(true), 9 * leaves(false));
}

}  // namespace
}  // namespace beambench::verify

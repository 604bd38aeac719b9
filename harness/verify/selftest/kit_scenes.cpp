#include "harness/verify/selftest/kit_scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "accel/core/primary_rays.hpp"
#include "harness/verify/selftest/closed_mesh.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::verify {
namespace {

using accel::Ray;

constexpr const char* kUsual =
    "t within K u of the exact one; if a ray passes an edge within K u, hit or miss";
constexpr const char* kTies =
    "t within K u of the exact one, and any of the primitives that lie there";

bool is_whole(const Ray& ray) { return ray.t_min == 0.0F && ray.t_max == accel::kInfinity; }

/// Returns thousands of unit squares in one plane, and rays through their corners, edges and
/// middles.
SceneWithRays coplanar_squares() {
  constexpr int kSide = 64;
  scenes::SceneBuilder builder("squares in a plane");
  for (int i = 0; i < kSide * kSide; ++i) {
    const double x = i % kSide;
    const double y = i / kSide;
    builder.add_polygon(std::array<glm::dvec3, 4>{
        {{x, y, 1.0}, {x + 1.0, y, 1.0}, {x + 1.0, y + 1.0, 1.0}, {x, y + 1.0, 1.0}}});
  }
  SceneWithRays made{std::move(builder).build(), {}};
  Random random(7);
  for (int i = 0; i < 600; ++i) {
    // One number a statement: compilers may evaluate arguments in any order.
    glm::vec3 target(1.0F);
    for (const int axis : {1, 0}) target[axis] = 0.5F * static_cast<float>(random.below(2 * kSide));
    glm::vec3 origin(random.below(2) == 0 ? -3.0F : 5.0F);
    for (const int axis : {1, 0}) {
      origin[axis] = target[axis] + static_cast<float>(random.below(9)) - 4.0F;
    }
    made.rays.push_back({.origin = origin, .direction = target - origin});
  }
  return made;
}

/// Returns twenty triangles, each fifty times.
SceneWithRays duplicates() {
  scenes::SceneBuilder builder("duplicates");
  Random random(11);
  for (int i = 0; i < 20; ++i) {
    const glm::dvec3 at = point_in_cube(random);
    const std::array<glm::dvec3, 3> corners{at, at + point_in_cube(random),
                                            at + point_in_cube(random)};
    for (int copy = 0; copy < 50; ++copy) builder.add_polygon(corners);
  }
  SceneWithRays made{std::move(builder).build(), {}};
  for (int i = 0; i < 400; ++i) {
    const auto& vertex = made.scene.triangles[random.below(made.scene.triangles.size())].vertex;
    const auto corner = [&](int k) {
      return glm::dvec3(made.scene.vertices[vertex[static_cast<std::size_t>(k)]]);
    };
    const glm::dvec3 inside = 0.5 * corner(0) + 0.25 * corner(1) + 0.25 * corner(2);
    const glm::dvec3 origin = 4.0 * point_in_cube(random);
    made.rays.push_back({.origin = glm::vec3(origin), .direction = glm::vec3(inside - origin)});
  }
  return made;
}

/// Returns a square, hit at exactly t = 5 or at a t with many digits, and rays that end or begin at
/// the hit, at the next floats, or far from it.
SceneWithRays limits_at_the_hit() {
  scenes::SceneBuilder builder("limits at the hit");
  builder.add_polygon(std::array<glm::dvec3, 4>{
      {{-1.0, -1.0, 0.0}, {1.0, -1.0, 0.0}, {1.0, 1.0, 0.0}, {-1.0, 1.0, 0.0}}});
  SceneWithRays made{std::move(builder).build(), {}};
  for (const float length : {1.0F, 0.7F, 3.0F}) {
    for (int i = 0; i < 40; ++i) {
      const float x = -0.9F + 0.045F * static_cast<float>(i);
      const float t = 5.0F / length;
      const Ray ray{.origin = {x, 0.31F, 5.0F}, .direction = {0.0F, 0.0F, -length}};
      for (const float end : {std::nextafter(t, 0.0F), t, std::nextafter(t, 9.0F), 0.5F * t,
                              0.999F * t, 1.001F * t, 2.0F * t}) {
        Ray ends = ray;
        ends.t_max = end;
        made.rays.push_back(ends);
        Ray begins = ray;
        begins.t_min = end;
        made.rays.push_back(begins);
      }
    }
  }
  return made;
}

/// Passes scenes on, and collects the rays that have an interval in separate scenes.
class Kit {
 public:
  Kit(const SelftestEffort& effort, PrimitiveKinds kinds,
      const std::function<void(KitScene)>& visit)
      : effort_(effort), kinds_(kinds), visit_(visit) {}

  /// Adds rays, except those in the plane of a polygon, for which rounding alone decides.
  void add(const std::string& family, SceneWithRays made, const char* tolerance = kUsual) {
    std::erase_if(made.rays, [&](const Ray& ray) { return is_edge_on(made.scene, ray); });
    add_all(family, std::move(made), tolerance);
  }
  void add_all(const std::string& family, SceneWithRays made, const char* tolerance) {
    const auto ends = std::ranges::stable_partition(made.rays, is_whole);
    SceneWithRays parts{made.scene, {ends.begin(), ends.end()}};
    made.rays.erase(ends.begin(), ends.end());
    pass(family, std::move(made), tolerance, false);
    pass(kIntervalFamily, std::move(parts),
         "within K u of an end of the interval, hit or miss; otherwise as without an interval",
         false);
  }
  void add_closed(const std::string& family, ClosedMesh mesh, std::vector<Ray> rays) {
    pass(family, {std::move(mesh.scene), std::move(rays)},
         "any of the triangles that meet at an edge, but never a miss, because the surface is "
         "closed",
         true);
  }
  /// Adds the rays of an image and random rays.
  void add_seen(const std::string& family, scenes::Scene scene, std::uint64_t seed) {
    if (scene.primitives.empty() || !kinds_.include(scene)) return;
    Random random(seed);
    SceneWithRays made{std::move(scene), {}};
    const accel::PrimaryRays image(made.scene.cameras.front(), 24, 20, 1);
    image.for_each(0, image.height(),
                   [&](std::size_t, const Ray& ray) { made.rays.push_back(ray); });
    const std::vector<Ray> more = random_rays(made.scene, effort_.rays, random);
    made.rays.insert(made.rays.end(), more.begin(), more.end());
    add(family, std::move(made));
  }

 private:
  void pass(const std::string& family, SceneWithRays made, const char* tolerance, bool closed) {
    if (!made.rays.empty()) visit_({family, tolerance, std::move(made), closed});
  }

  SelftestEffort effort_;
  PrimitiveKinds kinds_;
  const std::function<void(KitScene)>& visit_;
};

void add_meshes(Kit& kit, std::uint64_t count) {
  Random random(23);
  const ClosedMesh mesh = closed_mesh(kMeshPlaces[0].center, kMeshPlaces[0].radius);
  kit.add_closed(kMeshPlaces[0].family, mesh, rays_from_inside(mesh, count, random));
  for (const MeshPlace& place : std::span(kMeshPlaces).subspan(1)) {
    const ClosedMesh scaled = closed_mesh(place.center, place.radius);
    kit.add_closed(place.family, scaled, rays_from_inside(scaled, count, random));
    kit.add_all(place.family, {scaled.scene, rays_at_edges(scaled, count, random)}, kUsual);
  }
  kit.add_all("edges and vertices", {mesh.scene, rays_at_edges(mesh, count, random)}, kUsual);
  kit.add_all("origins on surfaces", {mesh.scene, rays_from_surface(mesh, count, random)},
              "within K u of the origin, hit or miss; otherwise t within K u");
  kit.add_all("odd directions", {mesh.scene, rays_of_odd_directions(mesh, count, random)}, kUsual);
}

}  // namespace

void for_each_kit_scene(const SelftestEffort& effort, PrimitiveKinds kinds,
                        const std::function<void(KitScene)>& visit) {
  Kit kit(effort, kinds, visit);
  for (std::uint64_t i = 0; i < effort.scenes; ++i) {
    const std::uint64_t seed = effort.seed + i;
    kit.add_seen(std::string(kSceneFamilies[seed % kSceneFamilies.size()]),
                 family_scene(seed, kinds), seed);
  }
  for (std::uint64_t i = 0; i < effort.scenes; ++i) {
    const auto primitives = static_cast<int>(1 + i * 60 / effort.scenes);
    kit.add_seen("random", random_scene(effort.seed + i, primitives, kinds), effort.seed + i);
  }
  kit.add("duplicates", heap(kinds), kTies);
  for (scenes::Scene& scene : smallest_scenes()) {
    kit.add_seen("smallest", std::move(scene), effort.seed);
  }
  if (!kinds.polygons) return;
  kit.add("edges and vertices", cubes_on_a_lattice());
  kit.add("duplicates", duplicates(), kTies);
  kit.add("thousands in a plane", coplanar_squares());
  kit.add_all(kIntervalFamily, limits_at_the_hit(), kUsual);
  kit.add_all("rays in planes", block_of_squares(),
              "hit or miss for a polygon in whose plane the ray lies; surfaces in front of it "
              "and behind it as usual");
  add_meshes(kit, 2 * effort.rays);
}

}  // namespace beambench::verify

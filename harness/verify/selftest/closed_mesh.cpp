#include "harness/verify/selftest/closed_mesh.hpp"

#include <array>
#include <cstdint>
#include <utility>

#include <glm/geometric.hpp>

#include "harness/verify/selftest/test_scenes.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::verify {
namespace {

using accel::Ray;
using glm::dvec3;

constexpr int kSide = 14;  // squares along an edge of the cube that is made round

glm::dvec3 unit_direction(Random& random) {
  for (;;) {
    const dvec3 v = point_in_cube(random);
    const double length = glm::length(v);
    if (length > 0.1 && length <= 1.0) return v / length;
  }
}

Ray ray_to(const dvec3& origin, const dvec3& target) {
  return {.origin = glm::vec3(origin), .direction = glm::vec3(target - origin)};
}

std::array<dvec3, 3> corners_of(const scenes::Scene& scene, Random& random) {
  const auto& vertex = scene.triangles[random.below(scene.triangles.size())].vertex;
  return {scene.vertices[vertex[0]], scene.vertices[vertex[1]], scene.vertices[vertex[2]]};
}

}  // namespace

ClosedMesh closed_mesh(const dvec3& center, double radius) {
  // The surface of a cube of small squares; the same vertex is used by all squares that meet there.
  constexpr int kPoints = kSide + 1;
  constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  std::vector<std::uint32_t> index(static_cast<std::size_t>(kPoints * kPoints * kPoints), kNone);
  scenes::SceneBuilder builder("closed mesh");
  Random bumps(1999);
  const auto vertex = [&](const glm::ivec3& at) {
    std::uint32_t& known =
        index[static_cast<std::size_t>((at.z * kPoints + at.y) * kPoints + at.x)];
    if (known == kNone) {
      const dvec3 on_cube = dvec3(at) * (2.0 / kSide) - 1.0;
      known =
          builder.add_vertex(center + glm::normalize(on_cube) * (radius * bumps.uniform(0.8, 1.2)));
    }
    return known;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, kSide}) {
      for (int cell = 0; cell < kSide * kSide; ++cell) {
        glm::ivec3 a(0);
        a[axis] = side;
        a[(axis + 1) % 3] = cell % kSide;
        a[(axis + 2) % 3] = cell / kSide;
        glm::ivec3 u(0);
        glm::ivec3 v(0);
        u[(axis + 1) % 3] = 1;
        v[(axis + 2) % 3] = 1;
        builder.add_polygon(std::array{vertex(a), vertex(a + u), vertex(a + u + v)});
        builder.add_polygon(std::array{vertex(a), vertex(a + u + v), vertex(a + v)});
      }
    }
  }
  return {std::move(builder).build(), center, radius};
}

dvec3 vertex_or_edge(const scenes::Scene& scene, Random& random) {
  const auto [a, b, c] = corners_of(scene, random);
  return random.below(2) == 0 ? a : 0.5 * (a + b);
}

std::vector<Ray> rays_from_inside(const ClosedMesh& mesh, std::uint64_t count, Random& random) {
  std::vector<Ray> rays;
  for (std::uint64_t i = 0; i < count; ++i) {
    const dvec3 origin = mesh.center + 0.25 * mesh.radius * point_in_cube(random);
    rays.push_back(ray_to(
        origin, i % 4 == 0 ? origin + unit_direction(random) : vertex_or_edge(mesh.scene, random)));
  }
  return rays;
}

std::vector<Ray> rays_at_edges(const ClosedMesh& mesh, std::uint64_t count, Random& random) {
  std::vector<Ray> rays;
  for (std::uint64_t i = 0; i < count; ++i) {
    const dvec3 target = vertex_or_edge(mesh.scene, random);
    dvec3 from = mesh.center + 3.0 * mesh.radius * unit_direction(random);
    if (i % 3 == 0) {
      const int axis = static_cast<int>(random.below(3));
      const double side = random.below(2) == 0 ? -3.0 : 3.0;
      from = target;
      from[axis] = mesh.center[axis] + side * mesh.radius;
    }
    rays.push_back(ray_to(from, target));
  }
  return rays;
}

std::vector<Ray> rays_from_surface(const ClosedMesh& mesh, std::uint64_t count, Random& random) {
  std::vector<Ray> rays;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto [a, b, c] = corners_of(mesh.scene, random);
    const double u = random.uniform(0.1, 0.8);
    const double v = random.uniform(0.1, 0.9 - u);
    const dvec3 origin = a + u * (b - a) + v * (c - a);
    rays.push_back(ray_to(origin, origin + mesh.radius * unit_direction(random)));
  }
  return rays;
}

std::vector<Ray> rays_of_odd_directions(const ClosedMesh& mesh, std::uint64_t count,
                                        Random& random) {
  constexpr std::array<float, 6> kSmall{0.0F, -0.0F, 1e-40F, -1e-40F, 1e-45F, -1e-38F};
  constexpr std::array<float, 6> kLengths{1e-12F, 1e-9F, 1e-6F, 1e3F, 1e6F, 1e8F};
  std::vector<Ray> rays;
  for (std::uint64_t i = 0; i < count; ++i) {
    const dvec3 origin = mesh.center + 0.25 * mesh.radius * point_in_cube(random);
    Ray ray = ray_to(origin, origin + unit_direction(random));
    if (i % 2 == 0) {
      const int kept = static_cast<int>(random.below(3));
      for (int axis = 0; axis < 3; ++axis) {
        if (axis == kept || (i % 4 == 0 && axis == (kept + 1) % 3)) continue;
        ray.direction[axis] = kSmall[random.below(kSmall.size())];
      }
    } else {
      ray.direction *= kLengths[random.below(kLengths.size())];
    }
    rays.push_back(ray);
  }
  return rays;
}

}  // namespace beambench::verify

#include "harness/verify/selftest/awkward_scenes.hpp"

#include <array>
#include <utility>

#include "harness/verify/selftest/random_scene.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::verify {
namespace {

/// The square with its lower corner there, in the plane across an axis.
std::array<glm::dvec3, 4> square(const glm::dvec3& lower, int axis) {
  std::array<glm::dvec3, 4> corners;
  corners.fill(lower);
  corners[1][(axis + 1) % 3] += 1.0;
  corners[2][(axis + 1) % 3] += 1.0;
  corners[2][(axis + 2) % 3] += 1.0;
  corners[3][(axis + 2) % 3] += 1.0;
  return corners;
}

void add_cube(scenes::SceneBuilder& builder, const glm::dvec3& lower) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {0.0, 1.0}) {
      glm::dvec3 corner = lower;
      corner[axis] += side;
      builder.add_polygon(square(corner, axis));
    }
  }
}

/// -1, 0 or 1: a digit of a number to the base of three.
int digit(int number, int place) { return number / place % 3 - 1; }

}  // namespace

SceneWithRays cubes_on_a_lattice() {
  scenes::SceneBuilder builder("cubes");
  for (int cube = 0; cube < 8; ++cube) {
    add_cube(builder, {2.0 * (cube & 1), 2.0 * (cube >> 1 & 1), 2.0 * (cube >> 2)});
  }
  SceneWithRays made{std::move(builder).build(), {}};
  for (int from = 0; from < 9 * 9 * 9; ++from) {
    const glm::ivec3 place(from % 9, from / 9 % 9, from / 81);
    for (int way = 0; way < 27; ++way) {
      if (way == 13) continue;  // no direction at all
      accel::Ray ray;
      ray.origin = glm::vec3(place) * 0.75F - 1.5F;
      ray.direction = {digit(way, 1), digit(way, 3), digit(way, 9)};
      made.rays.push_back(ray);
    }
  }
  return made;
}

SceneWithRays block_of_squares() {
  scenes::SceneBuilder builder("block");
  for (int axis = 0; axis < 3; ++axis) {
    for (int u = 0; u < 4; ++u) {
      for (int v = 0; v < 4; ++v) {
        glm::dvec3 lower(0.0);
        lower[(axis + 1) % 3] = u;
        lower[(axis + 2) % 3] = v;
        builder.add_polygon(square(lower, axis));
      }
    }
  }
  SceneWithRays made{std::move(builder).build(), {}};
  for (int axis = 0; axis < 3; ++axis) {
    for (const float way : {-1.0F, 1.0F}) {
      for (int u = -1; u <= 9; ++u) {
        for (int v = -1; v <= 9; ++v) {
          accel::Ray ray;
          ray.origin[axis] = -3.0F * way;
          ray.origin[(axis + 1) % 3] = 0.5F * static_cast<float>(u);
          ray.origin[(axis + 2) % 3] = 0.5F * static_cast<float>(v);
          for (const float zero : {0.0F, -0.0F}) {
            ray.direction = glm::vec3(zero);
            ray.direction[axis] = way;
            made.rays.push_back(ray);
          }
        }
      }
    }
  }
  return made;
}

SceneWithRays heap(PrimitiveKinds kinds) {
  constexpr int kPrimitives = 10'000;
  const std::array<glm::dvec3, 3> triangle{{{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.25}, {0.25, 2.0, 0.0}}};
  scenes::SceneBuilder builder("heap");
  for (int i = 0; i < kPrimitives; ++i) {
    if (kinds.spheres) {
      builder.add_sphere({0.25, 0.5, -0.125}, 0.5);
    } else if (kinds.cones) {
      builder.add_cone({0.25, 0.0, 0.0}, 0.5, {0.25, 1.0, 0.0}, 0.25);
    } else {
      builder.add_polygon(triangle);
    }
  }
  SceneWithRays made{std::move(builder).build(), {}};
  Random random(1);
  for (int i = 0; i < 20; ++i) made.rays.push_back(random_ray(made.scene, random));
  made.rays.front() = accel::Ray{{0.25F, 0.5F, 4.0F}, 0.0F, {0.0F, 0.0F, -1.0F}, accel::kInfinity};
  return made;
}

std::vector<scenes::Scene> smallest_scenes() {
  std::vector<scenes::Scene> scenes;
  scenes.push_back(scenes::SceneBuilder("empty").build());
  scenes::SceneBuilder sphere("one sphere");
  sphere.add_sphere({0.5, -0.25, 2.0}, 0.75);
  scenes.push_back(std::move(sphere).build());
  scenes::SceneBuilder cone("one cone");
  cone.add_cone({0.0, 0.0, 0.0}, 0.5, {0.0, 1.0, 0.0}, 0.25);
  scenes.push_back(std::move(cone).build());
  scenes::SceneBuilder triangle("one triangle");
  triangle.add_polygon(
      std::array<glm::dvec3, 3>{{{0.0, 0.0, 1.0}, {2.0, 0.0, 1.0}, {0.0, 1.0, 1.0}}});
  scenes.push_back(std::move(triangle).build());
  return scenes;
}

std::vector<accel::Ray> degenerate_rays(const scenes::Scene& scene, std::uint64_t seed) {
  constexpr int kRays = 400;
  Random random(seed);
  std::vector<accel::Ray> rays;
  for (int i = 0; i < kRays; ++i) {
    accel::Ray ray = random_ray(scene, random);
    switch (i % 4) {
      case 0:
        ray.direction *= random.below(2) == 0 ? 0x1p-30F : 0x1p+20F;
        break;
      case 1:
        ray.direction = {1.0F, 0x1p-20F, -0x1p-30F};
        break;
      case 2:
        ray.t_max = ray.t_min;
        break;
      default:
        ray.t_min = 1.0F;
        ray.t_max = 0.5F;
        break;
    }
    rays.push_back(ray);
  }
  return rays;
}

}  // namespace beambench::verify

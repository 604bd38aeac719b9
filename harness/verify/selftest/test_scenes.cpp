#include "harness/verify/selftest/test_scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "harness/verify/tolerance.hpp"
#include "scenes/base/error.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::verify {
namespace {

glm::dvec3 any_direction(Random& random) {
  while (true) {
    const glm::dvec3 direction = point_in_cube(random);
    if (glm::dot(direction, direction) > 1e-3) return direction;
  }
}

/// Makes the primitives of one scene.
class Sculptor {
 public:
  Sculptor(std::uint64_t seed, PrimitiveKinds kinds, scenes::SceneBuilder& builder)
      : random_(seed), kinds_(kinds), builder_(builder) {
    switch (seed % 4) {
      case 0:
        snap_ = 8.0;
        break;
      case 1:
        repeat_ = true;
        break;
      case 2:
        shift_ = glm::dvec3(1000.0, -2000.0, 500.0);
        break;
      default:
        break;
    }
  }

  void add_primitive() {
    const int copies = repeat_ && random_.below(4) == 0 ? 2 : 1;
    const Random before = random_;
    for (int copy = 0; copy < copies; ++copy) {
      random_ = before;
      try {
        add_one();
      } catch (const InputError&) {
        // Snapping may leave a primitive degenerate; the builder refuses it, and so do we.
      }
    }
  }

 private:
  void add_one() {
    switch (any_kind()) {
      case 0:
      case 1:
        builder_.add_sphere(place(point_in_cube(random_)), sign() * size());
        break;
      case 2: {
        const glm::dvec3 base = point_in_cube(random_);
        const double side = sign();
        const glm::dvec3 apex = base + any_direction(random_) * size();
        const double tip = random_.below(3) == 0 ? 0.0 : size();
        // A cone seen from the inside only has no tip: both radii are negative.
        builder_.add_cone(place(base), side * size(), place(apex), side < 0.0 ? -size() : tip);
        break;
      }
      case 3:
        add_star();
        break;
      default:
        add_triangle();
        break;
    }
  }

  /// Returns 0 or 1 for a sphere; 2 for a cone; 3 for a star; 4 or 5 for a triangle.
  std::uint64_t any_kind() {
    while (true) {
      const std::uint64_t drawn = random_.below(6);
      const scenes::PrimitiveKind kind = drawn < 2    ? scenes::PrimitiveKind::kSphere
                                         : drawn == 2 ? scenes::PrimitiveKind::kCone
                                                      : scenes::PrimitiveKind::kPolygon;
      if (kinds_.include(kind)) return drawn;
    }
  }

  void add_triangle() {
    const glm::dvec3 center = point_in_cube(random_);
    const double radius = random_.below(8) == 0 ? 1.5 : 2.0 * size();
    const std::array<glm::dvec3, 3> corners{place(center + point_in_cube(random_) * radius),
                                            place(center + point_in_cube(random_) * radius),
                                            place(center + point_in_cube(random_) * radius)};
    builder_.add_polygon(corners);
  }

  /// Adds a star polygon (concave) in a random plane; snapped scenes use a coordinate plane.
  void add_star() {
    const glm::dvec3 center = point_in_cube(random_);
    glm::dvec3 u = glm::normalize(any_direction(random_));
    glm::dvec3 v = glm::normalize(glm::cross(u, any_direction(random_)));
    if (snap_ > 0.0) {
      u = {1.0, 0.0, 0.0};
      v = {0.0, 1.0, 0.0};
    }
    const std::uint64_t tips = 3 + random_.below(5);
    const double radius = 2.5 * size();
    std::vector<glm::dvec3> corners;
    for (std::uint64_t i = 0; i < 2 * tips; ++i) {
      const double angle = 3.14159265358979 * static_cast<double>(i) / static_cast<double>(tips);
      const double reach = radius * (i % 2 == 0 ? 1.0 : random_.uniform(0.3, 0.9));
      corners.push_back(
          place(center + u * (reach * std::cos(angle)) + v * (reach * std::sin(angle))));
    }
    builder_.add_polygon(corners);
  }

  glm::dvec3 place(const glm::dvec3& point) const { return snapped(point) + shift_; }
  glm::dvec3 snapped(const glm::dvec3& point) const {
    return snap_ > 0.0 ? glm::round(point * snap_) / snap_ : point;
  }
  double size() {
    const double size = random_.uniform(0.02, 0.4);
    return snap_ > 0.0 ? std::ceil(size * snap_) / snap_ : size;
  }
  double sign() { return random_.below(5) == 0 ? -1.0 : 1.0; }

  Random random_;
  PrimitiveKinds kinds_;
  scenes::SceneBuilder& builder_;
  double snap_ = 0.0;
  bool repeat_ = false;
  glm::dvec3 shift_{0.0};
};

glm::dvec3 middle_of(const scenes::Scene& scene) {
  return (glm::dvec3(scene.bounds.lower) + glm::dvec3(scene.bounds.upper)) * 0.5;
}

/// Returns a point on the scene worth aiming at or starting from.
glm::dvec3 special_point(const scenes::Scene& scene, Random& random) {
  if (scene.primitives.empty()) return point_in_cube(random);
  const scenes::Primitive& primitive = scene.primitives[random.below(scene.primitives.size())];
  if (primitive.kind == scenes::PrimitiveKind::kSphere)
    return scene.spheres[primitive.index].center;
  if (primitive.kind == scenes::PrimitiveKind::kCone) return scene.cones[primitive.index].apex;
  const scenes::Polygon& polygon = scene.polygons[primitive.index];
  const auto corner = [&](std::uint64_t i) {
    return glm::dvec3(
        scene.vertices[scene.corners[polygon.first_corner + i % polygon.corner_count]]);
  };
  const std::uint64_t i = random.below(polygon.corner_count);
  return random.below(2) == 0 ? corner(i) : (corner(i) + corner(i + 1)) * 0.5;
}

glm::dvec3 random_origin(const scenes::Scene& scene, Random& random) {
  const glm::dvec3 middle = middle_of(scene);
  const glm::dvec3 extent(scene.bounds.extent());
  glm::dvec3 origin = middle + point_in_cube(random) * extent * 0.5;
  switch (random.below(5)) {
    case 0:
      return middle +
             glm::normalize(any_direction(random)) * glm::length(extent) * random.uniform(0.6, 4.0);
    case 1:  // on one, two or three of the planes through the middle
      for (int axis = 0; axis < 3; ++axis) {
        if (random.below(2) == 0) origin[axis] = middle[axis];
      }
      return origin;
    case 2:
      return special_point(scene, random);
    default:
      return origin;
  }
}

glm::dvec3 random_direction(const scenes::Scene& scene, const glm::dvec3& origin, Random& random) {
  switch (random.below(4)) {
    case 0: {  // along an axis or a diagonal
      glm::dvec3 direction(0.0);
      while (direction == glm::dvec3(0.0)) {
        for (int axis = 0; axis < 3; ++axis) {
          direction[axis] = static_cast<double>(random.below(3)) - 1.0;
        }
      }
      return direction;
    }
    case 1: {
      const glm::dvec3 direction = special_point(scene, random) - origin;
      return glm::length(direction) > 1e-6 ? direction : glm::dvec3(0.0, 0.0, 1.0);
    }
    default:
      return any_direction(random);
  }
}

/// Returns the unit square whose lower corner is `lower`, perpendicular to an axis.
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

/// Returns -1, 0 or 1: a digit of a number in base three.
int digit(int number, int place) { return number / place % 3 - 1; }

}  // namespace

glm::dvec3 point_in_cube(Random& random) {
  return {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
}

scenes::Scene random_scene(std::uint64_t seed, int primitives, PrimitiveKinds kinds) {
  scenes::SceneBuilder builder(fmt::format("random {}", seed));
  Sculptor sculptor(seed, kinds, builder);
  for (int i = 0; i < primitives; ++i) sculptor.add_primitive();
  while (builder.primitive_count() == 0) sculptor.add_primitive();  // all were degenerate
  return std::move(builder).build();
}

accel::Ray random_ray(const scenes::Scene& scene, Random& random) {
  accel::Ray ray;
  ray.origin = glm::vec3(random_origin(scene, random));
  ray.direction = glm::vec3(random_direction(scene, glm::dvec3(ray.origin), random));
  if (ray.direction == glm::vec3(0.0F)) ray.direction.x = 1.0F;
  if (random.below(4) == 0) {
    ray.t_min = static_cast<float>(random.uniform(0.0, 0.5));
    ray.t_max = static_cast<float>(random.uniform(0.0, 3.0));
  }
  return ray;
}

std::vector<accel::Ray> random_rays(const scenes::Scene& scene, std::uint64_t count,
                                    Random& random) {
  std::vector<accel::Ray> rays;
  rays.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) rays.push_back(random_ray(scene, random));
  return rays;
}

scenes::Camera random_camera(const scenes::Scene& scene, Random& random) {
  scenes::Camera camera;
  camera.from = glm::vec3(random_origin(scene, random));
  const glm::dvec3 from(camera.from);
  const glm::dvec3 direction = glm::normalize(random_direction(scene, from, random));
  // At least as long as a float can represent at the camera's distance from the origin.
  const double reach =
      std::max<double>(glm::length(glm::dvec3(scene.bounds.extent())), 1e-3 * glm::length(from));
  camera.at = glm::vec3(from + direction * reach);
  int across = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(direction[axis]) < std::abs(direction[across])) across = axis;
  }
  camera.up = glm::vec3(0.0F);
  camera.up[across] = random.below(2) == 0 ? 1.0F : -1.0F;
  camera.angle = static_cast<float>(random.uniform(5.0, 150.0));
  return camera;
}

void add_lights(scenes::Scene& scene, Random& random) {
  for (int i = 0; i < 2; ++i) {
    scene.lights.push_back({.position = glm::vec3(random_origin(scene, random))});
  }
}

bool is_edge_on(const scenes::Scene& scene, const accel::Ray& ray) {
  constexpr double kMinSine = 1.0 / kAlong;  // below, float cannot distinguish places on the ray
  const glm::dvec3 direction(ray.direction);
  return std::ranges::any_of(scene.triangles, [&](const scenes::Triangle& triangle) {
    const glm::dvec3 first(scene.vertices[triangle.vertex[0]]);
    const glm::dvec3 normal = glm::cross(glm::dvec3(scene.vertices[triangle.vertex[1]]) - first,
                                         glm::dvec3(scene.vertices[triangle.vertex[2]]) - first);
    return std::abs(glm::dot(normal, direction)) <=
           kMinSine * glm::length(normal) * glm::length(direction);
  });
}

SceneWithRays cubes_on_a_lattice() {
  scenes::SceneBuilder builder("cubes");
  for (int cube = 0; cube < 8; ++cube) {
    add_cube(builder, {2.0 * (cube & 1), 2.0 * (cube >> 1 & 1), 2.0 * (cube >> 2)});
  }
  SceneWithRays made{std::move(builder).build(), {}};
  for (int from = 0; from < 9 * 9 * 9; ++from) {
    const glm::ivec3 place(from % 9, from / 9 % 9, from / 81);
    for (int step = 0; step < 27; ++step) {
      if (step == 13) continue;  // not a direction
      accel::Ray ray;
      ray.origin = glm::vec3(place) * 0.75F - 1.5F;
      ray.direction = {digit(step, 1), digit(step, 3), digit(step, 9)};
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
    for (const float sign : {-1.0F, 1.0F}) {
      for (int u = -1; u <= 9; ++u) {
        for (int v = -1; v <= 9; ++v) {
          accel::Ray ray;
          ray.origin[axis] = -3.0F * sign;
          ray.origin[(axis + 1) % 3] = 0.5F * static_cast<float>(u);
          ray.origin[(axis + 2) % 3] = 0.5F * static_cast<float>(v);
          for (const float zero : {0.0F, -0.0F}) {
            ray.direction = glm::vec3(zero);
            ray.direction[axis] = sign;
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

#include "harness/verify/selftest/random_scene.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "scenes/core/error.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::verify {

namespace {

glm::dvec3 point_in_cube(Random& random) {
  return {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
}

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

  /// 0 and 1: a sphere; 2: a cone; 3: a star; 4 and 5: a triangle.
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

  /// A star polygon (concave) in a random plane; snapped scenes use a coordinate plane.
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

/// A point on the scene worth aiming at or starting from.
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

}  // namespace

scenes::Scene random_scene(std::uint64_t seed, int primitives, PrimitiveKinds kinds) {
  scenes::SceneBuilder builder(fmt::format("random {}", seed));
  Sculptor sculptor(seed, kinds, builder);
  for (int i = 0; i < primitives; ++i) sculptor.add_primitive();
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

}  // namespace beambench::verify

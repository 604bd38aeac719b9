#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "harness/verify/selftest/test_scenes.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/random.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::verify {
namespace {

using glm::dvec3;

/// Returns a direction of unit length; along an axis in half of the cases.
dvec3 direction(Random& random) {
  if (random.below(2) == 0) {
    dvec3 axis(0.0);
    axis[static_cast<int>(random.below(3))] = random.below(2) == 0 ? 1.0 : -1.0;
    return axis;
  }
  while (true) {
    const dvec3 vector = point_in_cube(random);
    if (glm::length(vector) > 0.1) return glm::normalize(vector);
  }
}

/// Returns two unit vectors at right angles to `axis` and to each other.
std::array<dvec3, 2> across(const dvec3& axis) {
  const dvec3 size = glm::abs(axis);
  const dvec3 other = size.x <= size.y && size.x <= size.z ? dvec3(1.0, 0.0, 0.0)
                      : size.y <= size.z                   ? dvec3(0.0, 1.0, 0.0)
                                                           : dvec3(0.0, 0.0, 1.0);
  const dvec3 u = glm::normalize(glm::cross(axis, other));
  return {u, glm::cross(axis, u)};
}

/// Returns a number from 2^low to 2^high, all magnitudes equally often. (Inexact functions of
/// <cmath> differ between machines.)
double magnitude(Random& random, int low, int high) {
  const int exponent = low + static_cast<int>(random.below(static_cast<std::uint64_t>(high - low)));
  return std::ldexp(random.uniform(1.0, 2.0), exponent);
}

/// Makes one scene. Primitives that rounding to float makes degenerate are refused by the builder
/// and left out.
class FamilyMaker {
 public:
  FamilyMaker(std::uint64_t seed, PrimitiveKinds kinds)
      : random_(seed ^ 0x5DEECE66DULL),
        kinds_(kinds),
        builder_(fmt::format("{} {}", kSceneFamilies[seed % kSceneFamilies.size()], seed)) {
    builder_.add_light({4.0, 6.0, 8.0});
    builder_.add_light({-7.0, 3.0, -2.0}, dvec3(0.5));
  }

  scenes::Scene flat_cones() {
    const dvec3 axis = direction(random_);
    dvec3 base = 0.3 * point_in_cube(random_);
    const bool stacked = random_.below(2) == 0;
    for (int i = 0; i < 8; ++i) {
      const double radius = random_.uniform(0.2, 2.0);
      const double height = radius * magnitude(random_, -30, -7);
      const double apex = random_.below(4) == 0 ? radius : random_.uniform(0.0, 2.0);
      const dvec3 along = stacked ? axis : direction(random_);
      add_cone(base, radius, base + along * height, apex);
      base = stacked ? base + axis * random_.uniform(0.0, 0.2) : 0.5 * point_in_cube(random_);
    }
    return finished(eye_around());
  }

  scenes::Scene eye_on_geometry() {
    for (int i = 0; i < 6; ++i) add_any(point_in_cube(random_), 0.5);
    const dvec3 eye = 0.5 * point_in_cube(random_);
    if (kinds_.polygons && (random_.below(3) == 0 || !(kinds_.spheres || kinds_.cones))) {
      add_polygon_through(eye);
    } else if (kinds_.cones && (random_.below(2) == 0 || !kinds_.spheres)) {
      add_cone_through(eye);
    } else {
      const double radius = random_.uniform(0.2, 1.0);
      add_sphere(eye + direction(random_) * radius, sign() * radius);
    }
    return finished(eye);
  }

  scenes::Scene touching_spheres() {
    const double radius = random_.below(2) == 0 ? 0.5 : random_.uniform(0.1, 1.0);
    const dvec3 from = random_.below(2) == 0 ? dvec3(0.0) : point_in_cube(random_);
    for (int i = 0; i < 12; ++i) {
      dvec3 place;
      for (int axis = 0; axis < 3; ++axis) place[axis] = static_cast<double>(random_.below(3));
      add_ball(from + place * (2.0 * radius), radius);
    }
    dvec3 contact(0.0);
    contact[static_cast<int>(random_.below(3))] = radius;
    return finished(random_.below(2) == 0 ? from + contact : eye_around());
  }

  scenes::Scene tiny_scale() {
    const double scale = magnitude(random_, -24, -10);
    for (int i = 0; i < 15; ++i) add_any(point_in_cube(random_) * scale, 0.5 * scale);
    return finished(eye_around() * scale, scale);
  }

  scenes::Scene coplanar_polygons() {
    const dvec3 normal = direction(random_);
    const auto [u, v] = across(normal);
    const dvec3 origin = random_.below(2) == 0 ? dvec3(0.0) : point_in_cube(random_);
    for (int i = 0; i < 14; ++i) {
      const double off = random_.below(3) == 0 ? magnitude(random_, -27, -13) : 0.0;
      const dvec3 center = origin + u * random_.uniform(-1.0, 1.0) + v * random_.uniform(-1.0, 1.0);
      const double size = random_.uniform(0.2, 1.5);
      add_square(center + normal * off, u * size, v * size);
    }
    const bool in_plane = random_.below(3) == 0;
    return finished(in_plane ? origin + u * random_.uniform(-2.0, 2.0) : eye_around());
  }

  scenes::Scene needles() {
    for (int i = 0; i < 18; ++i) {
      const dvec3 along = direction(random_) * random_.uniform(0.5, 3.0);
      const double width = magnitude(random_, -20, -10);
      const dvec3 base = point_in_cube(random_) - 0.5 * along;
      if (kinds_.cones && (random_.below(2) == 0 || !kinds_.polygons)) {
        add_cone(base, width, base + along, random_.below(2) == 0 ? 0.0 : width);
      } else if (kinds_.polygons) {
        add_polygon({base, base + along, base + across(glm::normalize(along))[0] * width});
      } else {
        add_sphere(base, width);
      }
    }
    return finished(eye_around());
  }

  scenes::Scene nested() {
    const double apart = magnitude(random_, -20, -7);
    const dvec3 center = 0.2 * point_in_cube(random_);
    const dvec3 axis = direction(random_);
    for (int i = 0; i < 6; ++i) {
      const double radius = 1.0 + apart * i;
      add_ball(center, sign() * radius);
      if (kinds_.cones) {
        add_cone(center - axis * radius, 0.5 * radius, center + axis * radius, 0.5 * radius);
      }
    }
    return finished(random_.below(2) == 0 ? center + 0.3 * point_in_cube(random_) : eye_around());
  }

 private:
  void add_sphere(const dvec3& center, double radius) {
    if (!kinds_.spheres) return;
    attempt([&] { builder_.add_sphere(center, radius); });
  }
  void add_cone(const dvec3& base, double base_radius, const dvec3& apex, double apex_radius) {
    if (!kinds_.cones) {
      add_square(base, dvec3(base_radius, 0.0, 0.0), glm::normalize(apex - base) * base_radius);
      return;
    }
    attempt([&] { builder_.add_cone(base, base_radius, apex, apex_radius); });
  }
  void add_polygon(const std::vector<dvec3>& corners) {
    if (!kinds_.polygons) return;
    attempt([&] { builder_.add_polygon(corners); });
  }
  void add_square(const dvec3& center, const dvec3& u, const dvec3& v) {
    add_polygon({center - u - v, center + u - v, center + u + v, center - u + v});
  }
  /// Adds a sphere, or a box about it if spheres are left out.
  void add_ball(const dvec3& center, double radius) {
    if (kinds_.spheres) return add_sphere(center, radius);
    const double size = std::abs(radius);
    for (int axis = 0; axis < 3; ++axis) {
      dvec3 out(0.0);
      out[axis] = size;
      const auto [u, v] = across(out / size);
      for (const double side : {-1.0, 1.0}) add_square(center + out * side, u * size, v * size);
    }
    if (!kinds_.polygons) add_cone(center, size, center + dvec3(0.0, size, 0.0), size);
  }
  void add_any(const dvec3& center, double size) {
    const std::uint64_t kind = random_.below(3);
    const double radius = size * random_.uniform(0.1, 1.0);
    const dvec3 along = direction(random_) * radius;
    if (kind == 0 && kinds_.spheres) return add_sphere(center, sign() * radius);
    if (kind == 1 && kinds_.cones) {
      return add_cone(center, radius, center + along, random_.below(3) == 0 ? 0.0 : 0.5 * radius);
    }
    if (kinds_.polygons) {
      return add_polygon(
          {center, center + point_in_cube(random_) * size, center + point_in_cube(random_) * size});
    }
    kinds_.cones ? add_cone(center, radius, center + along, 0.0) : add_sphere(center, radius);
  }

  void add_polygon_through(const dvec3& eye) {
    const dvec3 normal = direction(random_);
    const auto [u, v] = across(normal);
    switch (random_.below(3)) {
      case 0:  // within
        return add_square(eye + u * random_.uniform(-0.5, 0.5), u, v);
      case 1:  // on an edge
        return add_square(eye + u + v * random_.uniform(-0.5, 0.5), u, v);
      default:  // at a corner
        return add_square(eye + u + v, u, v);
    }
  }
  void add_cone_through(const dvec3& eye) {
    const dvec3 axis = direction(random_);
    const dvec3 out = across(axis)[0];
    const double radius = random_.uniform(0.2, 1.0);
    switch (random_.below(3)) {
      case 0:  // on a cylinder
        return add_cone(eye + out * radius - axis * 0.5, radius, eye + out * radius + axis, radius);
      case 1:  // on the rim
        return add_cone(eye + out * radius, radius, eye + out * radius + axis, 0.5 * radius);
      default:  // at the tip
        return add_cone(eye - axis, radius, eye, 0.0);
    }
  }

  template <class Add>
  void attempt(Add add) {
    const std::array<scenes::Surface, 3> surfaces{
        scenes::Surface{.color = {0.9F, 0.5F, 0.2F}, .diffuse = 0.8F},
        scenes::Surface{.diffuse = 0.3F, .specular = 0.6F, .shine = 20.0F},
        scenes::Surface{.diffuse = 0.2F, .transmittance = 0.7F, .refraction_index = 1.4F}};
    builder_.set_surface(surfaces[random_.below(surfaces.size())]);
    try {
      add();
    } catch (const InputError&) {  // degenerate after rounding to float
    }
  }

  double sign() { return random_.below(5) == 0 ? -1.0 : 1.0; }
  dvec3 eye_around() { return direction(random_) * random_.uniform(0.5, 4.0); }

  /// Finishes the scene with a camera that looks at the middle, or in any direction if the eye is
  /// there.
  scenes::Scene finished(const dvec3& eye, double scale = 1.0) {
    scenes::Camera camera;
    camera.from = glm::vec3(eye);
    dvec3 at = 0.3 * scale * point_in_cube(random_);
    if (glm::length(at - eye) < 0.1 * scale) at = eye + direction(random_) * scale;
    camera.at = glm::vec3(at);
    camera.up = glm::vec3(across(glm::normalize(dvec3(camera.at) - dvec3(camera.from)))[0]);
    camera.angle = static_cast<float>(random_.uniform(30.0, 100.0));
    builder_.add_camera(camera);
    if (builder_.primitive_count() == 0) add_any(dvec3(0.0), scale);
    return std::move(builder_).build();
  }

  Random random_;
  PrimitiveKinds kinds_;
  scenes::SceneBuilder builder_;
};

}  // namespace

scenes::Scene family_scene(std::uint64_t seed, PrimitiveKinds kinds) {
  static constexpr std::array kMakers{
      &FamilyMaker::flat_cones, &FamilyMaker::eye_on_geometry,   &FamilyMaker::touching_spheres,
      &FamilyMaker::tiny_scale, &FamilyMaker::coplanar_polygons, &FamilyMaker::needles,
      &FamilyMaker::nested};
  static_assert(kMakers.size() == kSceneFamilies.size());
  FamilyMaker maker(seed, kinds);
  return (maker.*kMakers[seed % kMakers.size()])();
}

}  // namespace beambench::verify

#pragma once
// Scenes in which hits are hard to judge: a few primitives each.

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "harness/verify/selftest/test_scenes.hpp"
#include "scenes/base/random.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::exact {

inline glm::dvec3 unit_vector(Random& random) {
  for (;;) {
    const glm::dvec3 v = verify::point_in_cube(random);
    const double length = glm::length(v);
    if (length > 0.1 && length <= 1.0) return v / length;
  }
}

/// Returns a number whose logarithm is roughly uniform, between powers of two.
inline double log_uniform(int low, int high, Random& random) {
  const int exponent = low + static_cast<int>(random.below(static_cast<std::uint64_t>(high - low)));
  return std::ldexp(random.uniform(1.0, 2.0), exponent);
}

inline double snapped(double value) { return std::round(value * 8.0) / 8.0; }
inline glm::dvec3 snapped(const glm::dvec3& v) {
  return {snapped(v.x), snapped(v.y), snapped(v.z)};
}

/// Adds primitives in coordinates with y up; `turn` maps y to any axis of the scene.
class Modeller {
 public:
  Modeller(const char* name, std::size_t turn) : builder_(name), turn_(turn % 3) {}

  glm::dvec3 turned(const glm::dvec3& v) const {
    const std::array<double, 3> from{v.x, v.y, v.z};
    return {from[turn_], from[(turn_ + 1) % 3], from[(turn_ + 2) % 3]};
  }
  void add_polygon(std::vector<glm::dvec3> corners) {
    for (glm::dvec3& corner : corners) corner = turned(corner);
    attempt([&] { builder_.add_polygon(corners); });
  }
  void add_level_square(const glm::dvec3& center, double half) {
    add_polygon({center + glm::dvec3(-half, 0.0, -half), center + glm::dvec3(-half, 0.0, half),
                 center + glm::dvec3(half, 0.0, half), center + glm::dvec3(half, 0.0, -half)});
  }
  void add_sphere(const glm::dvec3& center, double radius) {
    attempt([&] { builder_.add_sphere(turned(center), radius); });
  }
  void add_cone(const glm::dvec3& base, double base_radius, const glm::dvec3& apex,
                double apex_radius) {
    attempt([&] { builder_.add_cone(turned(base), base_radius, turned(apex), apex_radius); });
  }
  /// Adds a sphere, cone or upright triangle standing on the point. Some cones are flat, some
  /// triangles thin.
  void add_object_on(const glm::dvec3& place, Random& random) {
    const double size = random.uniform(0.1, 0.6);
    const double seen = random.below(5) == 0 ? -1.0 : 1.0;  // visible from the inside only
    const double extreme = random.below(4) == 0 ? log_uniform(-12, 0, random) : 1.0;
    switch (random.below(3)) {
      case 0:
        return add_sphere(place + glm::dvec3(0.0, size, 0.0), seen * size);
      case 1:
        return add_cone(
            place, seen * size * random.uniform(0.2, 1.0),
            place + extreme * glm::dvec3(random.below(2) == 0 ? 0.0 : 0.3 * size, size, 0.0),
            random.below(3) == 0 ? 0.0 : seen * size * random.uniform(0.2, 1.0));
      default:
        return add_polygon({place,
                            place + extreme * glm::dvec3(size, 0.0, snapped(random.uniform(-1, 1))),
                            place + glm::dvec3(0.0, size, 0.0)});
    }
  }
  void add_objects_at_height(double height, int count, Random& random) {
    for (int i = 0; i < count; ++i) {
      glm::dvec3 place{random.uniform(-2.0, 2.0), height, random.uniform(-2.0, 2.0)};
      if (random.below(2) == 0) place.x = snapped(place.x);
      add_object_on(place, random);
    }
  }

  scenes::Scene build() && { return std::move(builder_).build(); }

 private:
  /// Adds a primitive unless it is degenerate.
  template <class Add>
  static void attempt(Add add) {
    try {
      add();
    } catch (const scenes::DegeneratePrimitive&) {
    }
  }

  scenes::SceneBuilder builder_;
  std::size_t turn_;
};

/// Returns small objects on a square of size 1e3 to 1e6.
inline scenes::Scene huge_floor(Random& random) {
  Modeller modeller("huge floor", random.below(3));
  const double height = random.below(2) == 0 ? 0.0 : random.uniform(-2.0, 2.0);
  const double half = std::array<double, 4>{1e3, 1e4, 1e5, 1e6}[random.below(4)];
  modeller.add_level_square({0.0, height, 0.0}, half);
  modeller.add_objects_at_height(height, 5, random);
  return std::move(modeller).build();
}

/// Returns surfaces one above another: squares, concentric spheres or coaxial cones, with gaps from
/// a hundredth to several hundred times K u.
inline scenes::Scene stack(Random& random) {
  Modeller modeller("stack", random.below(3));
  const double place = std::array<double, 4>{0.0, 0.0, 1.0, 30.0}[random.below(4)];
  const double unit = 16.0 * 0x1p-24 * (2.0 + 2.0 * place);
  const std::uint64_t kind = random.below(3);
  double height = 0.0;
  for (int layer = 0; layer < 5; ++layer) {
    const glm::dvec3 center(0.0, place + (kind == 0 ? height : 0.0), 0.0);
    if (kind == 0) modeller.add_level_square(center, random.uniform(0.5, 2.0));
    if (kind == 1) modeller.add_sphere(center, 1.0 + height);
    if (kind == 2) {
      modeller.add_cone(center, 1.0 + height, center + glm::dvec3(0.0, 1.5, 0.0), 0.5 + height);
    }
    height += unit * log_uniform(-7, 7, random);
  }
  modeller.add_object_on({0.3, place - 1.0, 0.2}, random);
  return std::move(modeller).build();
}

/// Returns squares in planes whose coordinates are multiples of 1/8, and objects on them.
inline scenes::Scene planes(Random& random) {
  Modeller upright("planes", random.below(3));
  const double level = snapped(random.uniform(-1.0, 1.0));
  upright.add_level_square({0.0, level, 0.0}, 1.0);
  upright.add_level_square({0.25, level, 0.5}, 1.0);  // coplanar, overlapping
  const double wall = snapped(random.uniform(-1.0, 1.0));
  upright.add_polygon(
      {{wall, level, -1.0}, {wall, level, 1.0}, {wall, 1.5, 1.0}, {wall, 1.5, -1.0}});
  upright.add_polygon({{-1.0, level, wall}, {1.0, level, wall}, {0.0, level + 1.0, wall}});
  upright.add_objects_at_height(level, 2, random);
  return std::move(upright).build();
}

/// Returns a room: floor, ceiling, a wall and objects on the floor.
inline scenes::Scene room(Random& random) {
  Modeller modeller("room", random.below(3));
  const double top = random.below(2) == 0 ? 1.1 : random.uniform(0.7, 3.0);
  modeller.add_level_square({0.0, 0.0, 0.0}, 3.0);
  modeller.add_level_square({0.0, top, 0.0}, 3.0);
  modeller.add_polygon({{-3.0, 0.0, -3.0}, {-3.0, 0.0, 3.0}, {-3.0, top, 3.0}, {-3.0, top, -3.0}});
  modeller.add_objects_at_height(0.0, 4, random);
  return std::move(modeller).build();
}

/// Returns a sheet of triangles that share edges, level or uneven, over a floor.
inline scenes::Scene sheet(Random& random) {
  Modeller modeller("sheet", random.below(3));
  const double rough = std::array<double, 3>{0.0, 1e-5, 0.2}[random.below(3)];
  const double slope = random.below(2) == 0 ? 0.0 : random.uniform(-1.0, 1.0);
  constexpr int kSide = 3;
  std::array<glm::dvec3, (kSide + 1) * (kSide + 1)> points;
  for (int i = 0; i <= kSide; ++i) {
    for (int j = 0; j <= kSide; ++j) {
      const double x = 0.5 * i - 0.75;
      points[static_cast<std::size_t>(i * (kSide + 1) + j)] = {
          x, slope * x + rough * random.uniform(-1.0, 1.0), 0.5 * j - 0.75};
    }
  }
  for (std::size_t i = 0; i < kSide; ++i) {
    for (std::size_t j = 0; j < kSide; ++j) {
      const std::size_t at = i * (kSide + 1) + j;
      modeller.add_polygon({points[at], points[at + 1], points[at + kSide + 2]});
      modeller.add_polygon({points[at], points[at + kSide + 2], points[at + kSide + 1]});
    }
  }
  modeller.add_level_square({0.0, -1.5, 0.0}, 4.0);
  return std::move(modeller).build();
}

/// Returns the scene with all coordinates multiplied by a power of two, which is exact.
inline scenes::Scene times_two_to(int power, scenes::Scene scene) {
  const float factor = std::ldexp(1.0F, power);
  for (glm::vec3& vertex : scene.vertices) vertex *= factor;
  for (scenes::Sphere& sphere : scene.spheres) {
    sphere.center *= factor;
    sphere.radius *= factor;
  }
  for (scenes::Cone& cone : scene.cones) {
    cone.base *= factor;
    cone.apex *= factor;
    cone.base_radius *= factor;
    cone.apex_radius *= factor;
  }
  scene.bounds.lower *= factor;
  scene.bounds.upper *= factor;
  return scene;
}

/// Returns random spheres, cones and concave polygons.
inline scenes::Scene general(Random& random) {
  return verify::random_scene(random.bits() % 100'000, 8);
}

}  // namespace beambench::exact

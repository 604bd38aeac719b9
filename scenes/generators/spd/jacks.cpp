#include <numbers>

#include <glm/mat3x3.hpp>

#include "scenes/base/portable_math.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kArm = 0.75;  // in a jack's cube of half-size 1; neighbors do not touch
constexpr double kCylinderRadius = 0.1 * kArm;
constexpr double kSphereRadius = 0.2 * kArm;

/// Adds a jack: three crossed cylinders with spheres on their ends.
void add_jack(SceneBuilder& builder, const glm::dmat3& axes, const glm::dvec3& center,
              double size) {
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 arm = kArm * size * axes[axis];
    builder.add_cone(center - arm, kCylinderRadius * size, center + arm, kCylinderRadius * size);
  }
  for (const double side : {1.0, -1.0}) {
    for (int axis = 0; axis < 3; ++axis) {
      builder.add_sphere(center + side * kArm * size * axes[axis], kSphereRadius * size);
    }
  }
}

/// Adds a jack and, in the middle of each octant between its arms, jacks of half its size.
void add_jacks(SceneBuilder& builder, const glm::dmat3& axes, const glm::dvec3& center, double size,
               std::int64_t generations) {
  add_jack(builder, axes, center, size);
  if (generations == 1) return;
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      for (const double z : {-0.5, 0.5}) {
        add_jacks(builder, axes, center + size * (axes * glm::dvec3(x, y, z)), 0.5 * size,
                  generations - 1);
      }
    }
  }
}

/// Returns the axes, turned by -20 degrees about y, then by -30 about x, as columns.
glm::dmat3 turned_axes() {
  const double cx = portable_cos(-30.0 * std::numbers::pi / 180.0);
  const double sx = portable_sin(-30.0 * std::numbers::pi / 180.0);
  const double cy = portable_cos(-20.0 * std::numbers::pi / 180.0);
  const double sy = portable_sin(-20.0 * std::numbers::pi / 180.0);
  return {cy, sx * sy, -cx * sy, 0.0, cx, sx, sy, -sx * cy, cx * cy};
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {0.0F, 0.0F, -8.0F},
                      .at = {0.0F, 0.0F, 0.0F},
                      .up = {0.0F, 1.0F, 0.0F},
                      .angle = 25.0F,
                      .hither = 0.001F,
                      .width = 256,
                      .height = 256});
  builder.set_background({0.2, 0.05, 0.2});
  builder.add_light({-10.0, 3.0, -20.0});
  builder.set_surface(
      {.color = {0.737F, 0.561F, 0.561F}, .diffuse = 0.7F, .specular = 0.7F, .shine = 11.1434F});
  add_jacks(builder, turned_axes(), glm::dvec3(0.0), 1.0, parameters.integer("n"));
  return std::move(builder).build();
}

}  // namespace

void register_jacks(Catalogue& catalogue) {
  catalogue.add({"jacks",
                 "Recursive jacks of 6 (8^n - 1) / 7 spheres and half as many cylinders (SPD)",
                 {integer_parameter("n", 1, 1, 8, "generations, each of half the size")},
                 generate,
                 "n"});
}

}  // namespace beambench::scenes::generators

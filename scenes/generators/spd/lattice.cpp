#include <array>
#include <cmath>

#include "scenes/catalogue.hpp"
#include "scenes/generators/spd/spd_sky.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kSphereRadius = 1.0 / 4.0;  // both radii are relative to a cell's edge
constexpr double kCylinderRadius = 1.0 / 16.0;

const Surface kSphereSurface = {
    .color = {0.9F, 0.9F, 0.9F}, .diffuse = 0.5F, .specular = 0.5F, .shine = 3.0827F};
const std::array<Surface, 3> kCylinderSurfaces = {
    {{.color = {0.9F, 0.1F, 0.1F}, .diffuse = 0.99F},
     {.color = {0.1F, 0.9F, 0.1F}, .diffuse = 0.99F},
     {.color = {0.1F, 0.1F, 0.9F}, .diffuse = 0.99F}}};

/// Adds a sphere at each corner of the cells and a cylinder along each edge.
void add_lattice(SceneBuilder& builder, std::int64_t n) {
  const double edge = 1.0 / static_cast<double>(n);
  // A cylinder begins inside its sphere, where it is certainly hidden.
  const double inset =
      0.99 * kSphereRadius * edge * (1.0 - std::sqrt(kCylinderRadius / kSphereRadius));
  for (std::int64_t x = 0; x <= n; ++x) {
    for (std::int64_t y = 0; y <= n; ++y) {
      for (std::int64_t z = 0; z <= n; ++z) {
        const std::array<std::int64_t, 3> at = {x, y, z};
        const glm::dvec3 corner = glm::dvec3(x, y, z) / static_cast<double>(n);
        builder.set_surface(kSphereSurface);
        builder.add_sphere(corner, kSphereRadius * edge);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (at[axis] == n) continue;
          glm::dvec3 along(0.0);
          along[static_cast<int>(axis)] = 1.0;
          builder.set_surface(kCylinderSurfaces[axis]);
          builder.add_cone(corner + inset * along, kCylinderRadius * edge,
                           corner + (edge - inset) * along, kCylinderRadius * edge);
        }
      }
    }
  }
}

Scene generate(const Parameters& parameters) {
  const std::int64_t n = parameters.integer("n");
  const double edge = 1.0 / static_cast<double>(n);
  // The eye is inside, in the middle of a cell.
  const double x = (static_cast<double>(n / 2) + 0.5) * edge;
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = glm::dvec3(x, 1.0, 1.0 - 0.5 * edge),
                      .at = glm::dvec3(x, -1.0, -1.0 - 0.5 * edge),
                      .up = {0.2F, 1.0F, 0.0F},
                      .angle = 60.0F});
  builder.set_background(kSpdSky);
  const glm::dvec3 light(std::sqrt(1.0 / 6.0));  // the SPD's lattice scales its lights
  builder.add_light({2.0, 0.5, 0.5}, light);
  builder.add_light({-1.0, 0.5, 0.5}, light);
  builder.add_light({0.5, 2.0, 0.5}, light);
  builder.add_light({0.5, -1.0, 0.5}, light);
  builder.add_light({0.5, 0.5, 2.0}, light);
  builder.add_light({0.5, 0.5, -1.0}, light);
  add_lattice(builder, n);
  return std::move(builder).build();
}

}  // namespace

void register_lattice(Catalogue& catalogue) {
  catalogue.add(
      {"lattice",
       "Cubic lattice of (n+1)^3 spheres and 3 n (n+1)^2 cylinders, seen from within (SPD)",
       {integer_parameter("n", 12, 1, 150, "cells along each axis")},
       generate,
       "n"});
}

}  // namespace beambench::scenes::generators

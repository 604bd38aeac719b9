#include "scenes/generators/spd/balls.hpp"

#include <array>
#include <cmath>

#include <glm/mat3x3.hpp>

#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

using Directions = std::array<glm::dvec3, 9>;

/// Returns the directions of the nine children in their parent's frame: six on the equator at
/// azimuth 15 + 60 k degrees, and three at an elevation whose tangent is sqrt 2, at azimuth 45 +
/// 120 k degrees. They are computed with square roots only, which are the same on every machine.
Directions child_directions() {
  const double cos15 = (std::sqrt(6.0) + std::sqrt(2.0)) / 4.0;
  const double sin15 = (std::sqrt(6.0) - std::sqrt(2.0)) / 4.0;
  const double half = std::sqrt(0.5);  // cos and sin of 45 degrees
  const double up = std::sqrt(2.0 / 3.0);
  const double out = std::sqrt(1.0 / 3.0);
  return {{{cos15, sin15, 0.0},
           {sin15, cos15, 0.0},
           {-half, half, 0.0},
           {-cos15, -sin15, 0.0},
           {-sin15, -cos15, 0.0},
           {half, -half, 0.0},
           {out * half, out * half, up},
           {-out * cos15, out * sin15, up},
           {out * sin15, -out * cos15, up}}};
}

/// Returns the smallest rotation that takes +z to the unit vector d.
glm::dmat3 rotation_from_z(const glm::dvec3& d) {
  if (d.z < -1.0 + 1e-9) return {1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0};
  const double k = 1.0 / (1.0 + d.z);
  return {{1.0 - d.x * d.x * k, -d.x * d.y * k, -d.x},
          {-d.x * d.y * k, 1.0 - d.y * d.y * k, -d.y},
          {d.x, d.y, d.z}};
}

/// Adds a sphere and its descendants; `frame` rotates directions into the sphere's own frame.
void add_spheres(SceneBuilder& builder, const Directions& directions, const glm::dvec3& center,
                 double radius, const glm::dmat3& frame, int depth) {
  builder.add_sphere(center, radius);
  if (depth == 0) return;
  for (const glm::dvec3& local : directions) {
    const glm::dvec3 direction = frame * local;
    add_spheres(builder, directions, center + direction * (radius * 4.0 / 3.0), radius / 3.0,
                rotation_from_z(direction), depth - 1);
  }
}

void add_floor(SceneBuilder& builder) {
  builder.set_surface({.color = {1.0F, 0.75F, 0.33F}, .diffuse = 0.8F});
  const std::array<glm::dvec3, 4> floor = {
      {{12.0, 12.0, -0.5}, {-12.0, 12.0, -0.5}, {-12.0, -12.0, -0.5}, {12.0, -12.0, -0.5}}};
  builder.add_polygon(floor);
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  Camera camera;
  camera.from = {2.1F, 1.3F, 1.7F};
  camera.at = {0.0F, 0.0F, 0.0F};
  camera.up = {0.0F, 0.0F, 1.0F};
  camera.hither = 0.01F;
  builder.add_camera(camera);
  builder.set_background({0.078, 0.361, 0.753});
  builder.add_light({4.0, 3.0, 2.0});
  builder.add_light({1.0, -4.0, 4.0});
  builder.add_light({-3.0, 1.0, 5.0});

  add_floor(builder);
  builder.set_surface(
      {.color = {1.0F, 0.9F, 0.7F}, .diffuse = 0.5F, .specular = 0.5F, .shine = 3.0827F});
  add_sphereflake(builder, glm::dvec3(0.0), 0.5, static_cast<int>(parameters.integer("n")));
  return std::move(builder).build();
}

}  // namespace

void add_sphereflake(SceneBuilder& builder, const glm::dvec3& center, double radius, int depth) {
  add_spheres(builder, child_directions(), center, radius, glm::dmat3(1.0), depth);
}

void register_balls(Catalogue& catalogue) {
  catalogue.add({"balls",
                 "Sphereflake of (9^(n+1) - 1) / 8 spheres over one floor polygon (Haines's SPD)",
                 {integer_parameter("n", 4, 0, 8, "levels of smaller spheres around the first")},
                 generate,
                 "n"});
}

}  // namespace beambench::scenes::generators

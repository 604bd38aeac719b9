#include <array>

#include "scenes/catalogue.hpp"
#include "scenes/generators/spd/sphereflake.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

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

void register_balls(Catalogue& catalogue) {
  catalogue.add({"balls",
                 "Sphereflake of (9^(n+1) - 1) / 8 spheres over one floor polygon (Haines's SPD)",
                 {integer_parameter("n", 4, 0, 8, "levels of smaller spheres around the first")},
                 generate,
                 "n"});
}

}  // namespace beambench::scenes::generators

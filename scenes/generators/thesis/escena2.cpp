#include <array>

#include "scenes/catalogue.hpp"
#include "scenes/generators/spd/balls.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  Camera camera;
  camera.from = {5.0F, -54.0F, 7.0F};
  camera.at = {0.0F, 0.0F, 0.0F};
  camera.up = {0.0F, 0.0F, 1.0F};
  builder.add_camera(camera);
  builder.set_background({0.078, 0.361, 0.753});
  builder.add_light({15.0, -30.0, 30.0});
  builder.add_light({-30.0, -20.0, 10.0});

  // The wall alone determines the cube around the scene. The cube has sides of 40, with the flake,
  // of radius 0.9, near its center. At level 6, a cell of the thesis's octree is 1.25 wide.
  builder.set_surface({.color = {0.55F, 0.75F, 0.45F}, .diffuse = 0.8F});
  const std::array<glm::dvec3, 4> wall = {
      {{-20.0, 10.0, -20.0}, {20.0, 10.0, -20.0}, {20.0, 10.0, 20.0}, {-20.0, 10.0, 20.0}}};
  builder.add_polygon(wall);
  builder.set_surface(
      {.color = {1.0F, 0.9F, 0.7F}, .diffuse = 0.5F, .specular = 0.5F, .shine = 3.0827F});
  add_sphereflake(builder, glm::dvec3(0.0), 0.5, 2);
  return std::move(builder).build();
}

}  // namespace

void register_escena2(Catalogue& catalogue) {
  catalogue.add(
      {"escena2",
       "The thesis's Escena 2: a large polygon at the back, and a tiny sphereflake of 91 spheres "
       "in the middle of a huge volume",
       {},
       generate});
}

}  // namespace beambench::scenes::generators

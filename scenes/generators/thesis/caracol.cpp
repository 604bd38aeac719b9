#include "scenes/catalogue.hpp"
#include "scenes/generators/spd/shells.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {-6.0F, -60.0F, 35.0F},
                      .at = {-1.0F, 8.0F, -25.5F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .angle = 36.0F});
  builder.set_background({0.10, 0.30, 0.42});
  builder.add_light({-100.0, -100.0, 100.0}, glm::dvec3(0.8));
  builder.add_light({120.0, -80.0, 20.0}, glm::dvec3(0.3));
  builder.set_surface(
      {.color = {1.0F, 0.72F, 0.45F}, .diffuse = 0.8F, .specular = 0.25F, .shine = 45.0F});
  // The shell of n = 5 has 5,761 spheres; the thesis prints 5,671. The 90 spheres at the tip are
  // left out; the largest of them is a fiftieth of the size of the whole shell.
  add_shell(builder, 180 << 5, 90);
  return std::move(builder).build();
}

}  // namespace

void register_caracol(Catalogue& catalogue) {
  catalogue.add({"caracol",
                 "The thesis's Caracol: a sea shell of 5,671 nearly concentric spheres",
                 {},
                 generate});
}

}  // namespace beambench::scenes::generators

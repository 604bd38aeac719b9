#include "scenes/catalogue.hpp"
#include "scenes/generators/spd/teapot.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/box.hpp"
#include "scenes/modelling/subdivide.hpp"

namespace beambench::scenes::generators {
namespace {

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {5.6F, 9.2F, 5.2F},
                      .at = {-0.15F, 0.1F, 0.2F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .angle = 53.0F});
  builder.set_background({0.16, 0.20, 0.28});
  builder.add_light({-3.1, 9.8, 12.1}, glm::dvec3(0.7));
  builder.add_light({11.3, 5.1, 8.8}, glm::dvec3(0.7));

  builder.set_surface(
      {.color = {0.80F, 0.84F, 0.90F}, .diffuse = 0.75F, .specular = 0.35F, .shine = 30.0F});
  add_teapot(builder, 4);
  // The tray stays slightly below the pot, so that all sides of both are visible.
  builder.set_surface({.color = {0.55F, 0.33F, 0.18F}, .diffuse = 0.85F});
  modelling::add_flat(
      builder, modelling::triangulated(modelling::box({-4.0, -4.0, -0.5}, {4.0, 4.0, -0.1})));
  return std::move(builder).build();
}

}  // namespace

void register_tetera(Catalogue& catalogue) {
  catalogue.add(
      {"tetera",
       "The thesis's Tetera: Newell's teapot of 992 triangles over a box of 12, in empty space",
       {},
       generate});
}

}  // namespace beambench::scenes::generators

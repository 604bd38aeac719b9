#include "scenes/catalogue.hpp"
#include "scenes/generators/thesis/iron_tower.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/subdivide.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr std::size_t kPolygons = 16648;

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {190.0F, -440.0F, 40.0F},
                      .at = {0.0F, 0.0F, 158.0F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .angle = 42.0F});
  builder.set_background({0.56, 0.76, 0.95});
  builder.add_light({500.0, -700.0, 600.0}, glm::dvec3(0.85));
  builder.add_light({-600.0, -300.0, 200.0}, glm::dvec3(0.4));

  builder.set_surface({.color = {0.50F, 0.36F, 0.24F}, .diffuse = 0.9F});
  modelling::add_flat(builder, iron_tower());
  modelling::add_flat(builder, tower_galleries());
  modelling::add_smooth(builder, tower_top());
  builder.set_surface({.color = {0.78F, 0.74F, 0.66F}, .diffuse = 0.9F});
  modelling::add_flat(builder, tower_foundations());
  builder.set_surface({.color = {0.60F, 0.45F, 0.31F}, .diffuse = 0.9F});
  modelling::add_flat(
      builder, modelling::subdivided_to(tower_floors(), kPolygons - builder.primitive_count()));
  return std::move(builder).build();
}

}  // namespace

void register_torre_eiffel(Catalogue& catalogue) {
  catalogue.add(
      {"torre-eiffel",
       "The thesis's Torre Eiffel: a lattice tower of 16,648 polygons with empty space around it",
       {},
       generate});
}

}  // namespace beambench::scenes::generators

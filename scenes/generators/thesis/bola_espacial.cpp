#include <array>
#include <cstddef>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "scenes/catalogue.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/parametric_surface.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr int kPanels = 16;      // panels along an edge of each of six sides: 1,536 polygons
constexpr int kPlatePanels = 4;  // panels along an edge of a plate of one color

/// Returns one side of a cube, inflated to the ball.
modelling::PolygonMesh side(int axis, double direction) {
  return modelling::parametric_surface(
      [axis, direction](double u, double v) {
        glm::dvec3 point;
        point[axis] = direction;
        point[(axis + 1) % 3] = direction * (2.0 * u - 1.0);
        point[(axis + 2) % 3] = 2.0 * v - 1.0;
        return glm::normalize(point);
      },
      kPanels, kPanels);
}

/// Returns the panels of all plates of one color, which form a checkerboard.
modelling::PolygonMesh plates(const modelling::PolygonMesh& whole, std::size_t color) {
  modelling::PolygonMesh part{whole.vertices, {}};
  for (std::size_t i = 0; i < whole.polygons.size(); ++i) {
    const std::size_t column = i % kPanels / kPlatePanels;
    const std::size_t row = i / kPanels / kPlatePanels;
    if ((column + row) % 2 == color) part.polygons.push_back(whole.polygons[i]);
  }
  return part;
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {5.0F, 2.0F, 2.0F},
                      .at = {0.0F, 0.0F, 0.0F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .angle = 22.0F});
  builder.set_background({0.02, 0.02, 0.07});
  builder.add_light({30.0, 6.0, 20.0}, glm::dvec3(0.8));
  builder.add_light({5.0, 30.0, -10.0}, glm::dvec3(0.4));

  constexpr std::array kColors = {glm::vec3(1.0F, 0.45F, 0.12F), glm::vec3(0.62F, 0.78F, 0.95F)};
  for (std::size_t color = 0; color < kColors.size(); ++color) {
    builder.set_surface(
        {.color = kColors[color], .diffuse = 0.8F, .specular = 0.3F, .shine = 20.0F});
    for (int axis = 0; axis < 3; ++axis) {
      for (const double direction : {-1.0, 1.0}) {
        modelling::add_flat(builder, plates(side(axis, direction), color));
      }
    }
  }
  return std::move(builder).build();
}

}  // namespace

// The thesis's own scene is lost. The thesis states that its 1,536 polygons are "very near to each
// other and occupy nearly all of the scene's space", with "very few free spaces" (section 5.4.2,
// figure 5.9). So the ball fills the picture and its box. Nothing is fitted to the thesis's ray
// counts and times for this scene.
void register_bola_espacial(Catalogue& catalogue) {
  catalogue.add({"bola-espacial",
                 "The thesis's Bola espacial: a ball of 1,536 panels that fills its box",
                 {},
                 generate});
}

}  // namespace beambench::scenes::generators

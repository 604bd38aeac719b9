#include <array>

#include <glm/gtc/matrix_transform.hpp>

#include "scenes/catalogue.hpp"
#include "scenes/generators/thesis/cartoon_cat.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/letters.hpp"
#include "scenes/modelling/subdivide.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr std::size_t kPolygons = 15128;

/// The name, hanging in the air behind the cat's ears.
modelling::PolygonMesh name() {
  constexpr double kHeight = 0.76;
  glm::dmat4 place = glm::translate(
      glm::dmat4(1.0), glm::dvec3(-0.5 * modelling::text_width("GATO BILL", kHeight), 1.6, 2.2));
  place[1] = glm::dvec4(0.0, 0.0, 1.0, 0.0);   // letters stand
  place[2] = glm::dvec4(0.0, -1.0, 0.0, 0.0);  // and look to the reader
  return modelling::transformed(modelling::extruded_text("GATO BILL", kHeight, 0.3), place);
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  Camera camera;
  camera.from = {-0.4F, -7.0F, 2.9F};
  camera.at = {0.0F, 0.0F, 1.22F};
  camera.up = {0.0F, 0.0F, 1.0F};
  camera.angle = 36.0F;
  builder.add_camera(camera);
  builder.set_background({0.55, 0.78, 0.95});
  builder.add_light({-4.0, -7.0, 8.0}, glm::dvec3(0.85));
  builder.add_light({5.0, -5.0, 4.0}, glm::dvec3(0.35));

  builder.set_surface({.color = {0.42F, 0.70F, 0.40F}, .diffuse = 0.9F});
  const std::array<glm::dvec3, 4> floor = {
      {{-6.0, -4.5, 0.0}, {6.0, -4.5, 0.0}, {6.0, 4.5, 0.0}, {-6.0, 4.5, 0.0}}};
  builder.add_polygon(floor);
  add_cartoon_cat(builder);
  builder.set_surface(
      {.color = {0.80F, 0.16F, 0.22F}, .diffuse = 0.8F, .specular = 0.3F, .shine = 20.0F});
  modelling::add_flat(builder, modelling::subdivided_to(modelling::triangulated(name()),
                                                        kPolygons - builder.primitive_count()));
  return std::move(builder).build();
}

}  // namespace

void register_gato_bill(Catalogue& catalogue) {
  catalogue.add(
      {"gato-bill",
       "The thesis's Gato-Bill: a cartoon cat on one large floor polygon before its name in "
       "letters",
       {},
       generate});
}

}  // namespace beambench::scenes::generators

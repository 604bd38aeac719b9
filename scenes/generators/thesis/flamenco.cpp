#include "scenes/catalogue.hpp"
#include "scenes/generators/thesis/flamingo.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/parametric_surface.hpp"
#include "scenes/modelling/subdivide.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr std::size_t kPolygons = 12874;
constexpr double kCell = 0.0193;

Surface surface_of(Plumage plumage) {
  switch (plumage) {
    case Plumage::kWing:
      return {.color = {0.94F, 0.36F, 0.42F}, .diffuse = 0.9F};
    case Plumage::kFlightFeathers:
      return {.color = {0.16F, 0.12F, 0.14F}, .diffuse = 0.9F};
    case Plumage::kLeg:
      return {.color = {0.90F, 0.50F, 0.48F}, .diffuse = 0.9F};
    case Plumage::kBill:
      return {.color = {0.97F, 0.84F, 0.78F}, .diffuse = 0.8F, .specular = 0.3F, .shine = 30.0F};
    case Plumage::kBillTip:
      return {.color = {0.10F, 0.09F, 0.10F}, .diffuse = 0.8F, .specular = 0.4F, .shine = 30.0F};
    default:
      return {.color = {1.0F, 0.64F, 0.66F}, .diffuse = 0.9F};
  }
}

void add_eyes(SceneBuilder& builder) {
  builder.set_surface(
      {.color = glm::vec3(0.05F), .diffuse = 0.8F, .specular = 0.6F, .shine = 50.0F});
  for (const double side : {-1.0, 1.0}) {
    modelling::PolygonMesh eye = modelling::ellipsoid(glm::dvec3(0.016), 12, 8);
    for (glm::dvec3& vertex : eye.vertices) vertex += glm::dvec3(0.425, 0.046 * side, 1.718);
    modelling::add_smooth(builder, modelling::outside(eye, flamingo_field));
  }
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {1.6F, -3.7F, 1.25F},
                      .at = {0.03F, 0.0F, 0.87F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .angle = 29.5F});
  builder.set_background({0.62, 0.86, 0.88});
  builder.add_light({3.0, -4.0, 5.0}, glm::dvec3(0.8));
  builder.add_light({-4.0, -3.0, 1.0}, glm::dvec3(0.4));

  add_eyes(builder);
  const modelling::Region region = [](const glm::dvec3& place) {
    return static_cast<int>(flamingo_plumage(place));
  };
  const modelling::PolygonMesh rough =
      modelling::implicit_surface(flamingo_field, {-0.62, -0.30, -0.03}, {0.65, 0.30, 1.80}, kCell);
  const modelling::PolygonMesh bird = modelling::subdivided_to(
      modelling::drawn_to_borders(modelling::triangulated(rough), flamingo_field, region),
      kPolygons - builder.primitive_count());
  modelling::add_smooth(builder, bird,
                        {.crease = 60.0, .paint = [&](std::size_t polygon) {
                           return surface_of(flamingo_plumage(modelling::middle(bird, polygon)));
                         }});
  return std::move(builder).build();
}

}  // namespace

void register_flamenco(Catalogue& catalogue) {
  catalogue.add(
      {"flamenco",
       "The thesis's Flamenco: a flamingo of 12,874 polygons on one leg, empty space around it",
       {},
       generate});
}

}  // namespace beambench::scenes::generators

#include "scenes/generators/thesis/room/room_lamps.hpp"

#include <array>

#include "scenes/generators/thesis/room/placed_piece.hpp"
#include "scenes/modelling/lathe.hpp"
#include "scenes/modelling/parametric_surface.hpp"
#include "scenes/modelling/profile.hpp"
#include "scenes/modelling/subdivide.hpp"

namespace beambench::scenes::generators {
namespace {

const Surface kBrass = {
    .color = {0.80F, 0.63F, 0.28F}, .diffuse = 0.8F, .specular = 0.7F, .shine = 50.0F};
const Surface kEnamel = {
    .color = {0.20F, 0.45F, 0.42F}, .diffuse = 0.85F, .specular = 0.5F, .shine = 50.0F};
const Surface kInside = {.color = {0.98F, 0.95F, 0.86F}, .diffuse = 1.0F};
const Surface kBulb = {.color = {1.0F, 0.98F, 0.88F}, .diffuse = 1.0F};

modelling::PolygonMesh bulb(double z) {
  modelling::PolygonMesh mesh = modelling::ellipsoid({0.045, 0.045, 0.058}, 14, 9);
  for (glm::dvec3& vertex : mesh.vertices) vertex.z += z;
  return mesh;
}

/// A lampshade of paper, open above and below, folded into pleats.
modelling::PolygonMesh pleated_shade(double low, double low_radius, double high,
                                     double high_radius) {
  constexpr int kPleats = 32;
  modelling::Profile profile({low_radius, low});
  profile.curve({high_radius, high}, -0.012, 4);
  modelling::PolygonMesh mesh = modelling::lathe(profile.points(), 2 * kPleats);
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 2) {
    mesh.vertices[i].x *= 1.035;
    mesh.vertices[i].y *= 1.035;
  }
  return mesh;
}

}  // namespace

void add_hanging_lamp(SceneBuilder& builder, const glm::dvec3& rim, double ceiling) {
  PlacedPiece lamp(builder, standing_at(rim));
  modelling::Profile shade({0.235, 0.0});
  shade.line({0.240, 0.006}).curve({0.10, 0.135}, 0.028, 7).line({0.045, 0.15}).line({0.04, 0.20});
  lamp.smooth(kEnamel, modelling::lathe(shade.points(), 32));
  modelling::Profile inside({0.035, 0.138});
  inside.line({0.095, 0.127}).curve({0.235, 0.0}, -0.026, 7);
  lamp.smooth(kInside, modelling::lathe(inside.points(), 32));
  lamp.smooth(kBulb, bulb(0.068));

  const double height = ceiling - rim.z;
  modelling::Profile cord({0.04, 0.20});
  cord.curve({0.006, 0.235}, 0.006, 5).line({0.006, height - 0.05});
  cord.curve({0.055, height - 0.004}, -0.012, 5).line({0.055, height});
  lamp.smooth(kBrass, modelling::lathe(cord.points(), 14));
}

void add_floor_lamp(SceneBuilder& builder, const glm::dvec3& place) {
  PlacedPiece lamp(builder, standing_at(place));
  modelling::Profile stand({0.15, 0.0});
  stand.line({0.15, 0.012})
      .curve({0.03, 0.045}, -0.006, 5)
      .curve({0.014, 0.08}, 0.008, 4)
      .line({0.012, 0.62})
      .curve({0.012, 0.70}, 0.020, 5)
      .line({0.012, 1.24})
      .curve({0.012, 1.30}, 0.016, 5)
      .line({0.010, 1.40});
  lamp.smooth(kBrass, modelling::lathe(stand.points(), 16));
  lamp.smooth(kBulb, bulb(1.445));
  lamp.flat({.color = {0.98F, 0.90F, 0.68F}, .diffuse = 1.0F},
            pleated_shade(1.32, 0.235, 1.66, 0.135));
}

}  // namespace beambench::scenes::generators

#include <cmath>
#include <numbers>
#include <vector>

#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/generators/thesis/plant.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/lathe.hpp"
#include "scenes/modelling/subdivide.hpp"
#include "scenes/modelling/sweep.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr std::size_t kPolygons = 1284;
constexpr int kLeaves = 30;
constexpr double kTop = 0.6;  // height of the stem at the last leaf

/// Returns the pot without its hidden bottom: the wall, the rim, and the inside down to the soil.
modelling::PolygonMesh pot() {
  const std::vector<glm::dvec2> profile = {{0.15, 0.00}, {0.20, 0.23}, {0.23, 0.23},
                                           {0.23, 0.30}, {0.21, 0.30}, {0.20, 0.26}};
  return modelling::lathe(profile, 16);
}

modelling::PolygonMesh soil() {
  const std::vector<glm::dvec2> profile = {{0.20, 0.26}, {0.0, 0.27}};
  return modelling::lathe(profile, 16);
}

modelling::PolygonMesh stem() {
  const std::vector<glm::dvec3> path = {
      {0.0, 0.0, 0.26}, {0.01, 0.01, 0.40}, {-0.01, 0.01, 0.54}, {0.0, 0.0, kTop + 0.02}};
  const std::vector<double> radii = {0.025, 0.020, 0.015, 0.0};
  return modelling::tube(path, radii, 6);
}

/// Returns leaves around the stem in the spiral of phyllotaxis (Vogel 1979): each leaf is a golden
/// angle farther around than the one below; lower leaves are long and drooping, upper leaves steep
/// and short.
modelling::PolygonMesh leaves() {
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  modelling::PolygonMesh mesh;
  Random random(1);
  for (int i = 0; i < kLeaves; ++i) {
    const double s = (i + 0.5) / kLeaves;
    ArchingLeaf leaf;
    leaf.root = {0.0, 0.0, std::lerp(0.30, kTop, s)};
    leaf.azimuth = golden * i + random.uniform(-0.15, 0.15);
    leaf.rise = std::lerp(0.4, 1.4, s) + random.uniform(-0.2, 0.2);
    leaf.fall = std::lerp(1.0, 0.6, s) + random.uniform(-0.3, 0.3);
    leaf.length = std::lerp(0.8, 0.3, s) * random.uniform(0.8, 1.1);
    leaf.width = 0.13 * random.uniform(0.85, 1.1);
    modelling::append(mesh, arching_leaf(leaf, 10));
  }
  return mesh;
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {1.8F, -2.4F, 1.1F},
                      .at = {0.0F, 0.0F, 0.4F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .angle = 18.0F});
  builder.set_background({0.80, 0.86, 0.88});
  builder.add_light({1.0, -4.0, 5.0}, glm::dvec3(0.9));
  builder.add_light({3.0, 1.0, 1.5}, glm::dvec3(0.4));

  builder.set_surface({.color = {0.76F, 0.38F, 0.22F}, .diffuse = 0.9F});
  modelling::add_smooth(builder, pot());
  builder.set_surface({.color = {0.25F, 0.16F, 0.10F}, .diffuse = 0.9F});
  modelling::add_smooth(builder, soil());
  builder.set_surface({.color = {0.42F, 0.36F, 0.18F}, .diffuse = 0.9F});
  modelling::add_smooth(builder, stem());
  builder.set_surface(
      {.color = {0.24F, 0.55F, 0.20F}, .diffuse = 0.85F, .specular = 0.2F, .shine = 12.0F});
  modelling::add_smooth(builder, modelling::subdivided_to(modelling::triangulated(leaves()),
                                                          kPolygons - builder.primitive_count()));
  return std::move(builder).build();
}

}  // namespace

// The thesis's own scene is lost. The thesis describes 1,284 polygons: a potted plant whose objects
// are "strongly distributed over the whole scene" (section 5.3.1). Nothing is fitted to the
// thesis's counts and times for this scene.
void register_maceta(Catalogue& catalogue) {
  catalogue.add(
      {"maceta", "The thesis's Maceta: a potted plant spread over the whole volume", {}, generate});
}

}  // namespace beambench::scenes::generators

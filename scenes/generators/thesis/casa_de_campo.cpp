#include <algorithm>
#include <array>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "scenes/catalogue.hpp"
#include "scenes/core/random.hpp"
#include "scenes/generators/thesis/country_house.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/extrusion.hpp"
#include "scenes/modelling/implicit_surface.hpp"
#include "scenes/modelling/lattice_work.hpp"
#include "scenes/modelling/rotation.hpp"
#include "scenes/modelling/subdivide.hpp"
#include "scenes/modelling/sweep.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr std::size_t kPolygons = 12172;

/// Squares of meadow and of the path to the door; none under the house and its porch.
void add_ground(SceneBuilder& builder) {
  const Surface meadow = {.color = {0.50F, 0.70F, 0.32F}, .diffuse = 0.9F};
  const Surface path = {.color = {0.80F, 0.71F, 0.53F}, .diffuse = 0.9F};
  for (int y = -13; y < 13; ++y) {
    for (int x = -13; x < 13; ++x) {
      const bool is_house = x >= -5 && x < 5 && y >= 0 && y < 7;
      const bool is_porch = x >= -2 && x < 2 && y >= -2 && y < 0;
      if (is_house || is_porch) continue;
      builder.set_surface(x >= -1 && x < 1 && y < 0 ? path : meadow);
      const std::array<glm::dvec3, 4> square = {
          {{x, y, 0.0}, {x + 1, y, 0.0}, {x + 1, y + 1, 0.0}, {x, y + 1, 0.0}}};
      builder.add_polygon(square);
    }
  }
}

/// Pickets with rails behind them along y = -7.6, open where the path goes through.
modelling::PolygonMesh fence() {
  constexpr double kY = -7.6;
  modelling::PolygonMesh picket = modelling::extruded(
      modelling::flat_polygon(
          {{-0.06, 0.03}, {0.06, 0.03}, {0.06, 0.95}, {0.0, 1.08}, {-0.06, 0.95}}),
      0.04);
  modelling::PolygonMesh mesh;
  for (const double side : {-1.0, 1.0}) {
    for (int i = 0; i < 40; ++i) {
      const glm::dvec3 foot(side * (1.35 + 0.29 * i), kY, 0.0);
      modelling::append(mesh, modelling::transformed(picket, glm::translate(glm::dmat4(1.0), foot) *
                                                                 modelling::rotation(0, 90.0)));
    }
    for (const double z : {0.3, 0.8}) {
      modelling::append(mesh, modelling::bar({side * 1.2, kY + 0.035, z},
                                             {side * 12.8, kY + 0.035, z}, {0.0, 1.0, 0.0}, 0.06));
    }
    const glm::dvec3 gatepost(side * 1.15, kY, 0.0);
    modelling::append(mesh, modelling::bar(gatepost, gatepost + glm::dvec3(0.0, 0.0, 1.25),
                                           {0.0, 1.0, 0.0}, 0.16));
  }
  return mesh;
}

/// A crown of clumps of leaves around a place.
modelling::Field crown(const glm::dvec3& center, double radius, std::uint64_t seed) {
  struct Clump {
    glm::dvec3 center;
    double radius;
  };
  std::vector<Clump> clumps = {{center, radius}};
  Random random(seed);
  while (clumps.size() < 26) {
    const glm::dvec3 way(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                         random.uniform(-0.8, 1.0));
    const double length = std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z);
    if (length > 1.0 || length < 0.3) continue;
    clumps.push_back(
        {center + way * (0.95 * radius / length), random.uniform(0.25, 0.42) * radius});
  }
  return [clumps](const glm::dvec3& place) {
    double d = 1e9;
    for (const Clump& clump : clumps) {
      const glm::dvec3 off = place - clump.center;
      const double distance = std::sqrt(off.x * off.x + off.y * off.y + off.z * off.z);
      d = modelling::joined(d, distance - clump.radius, 0.12);
    }
    return d;
  };
}

struct Tree {
  glm::dvec2 place;
  double height;  ///< of its crown's middle
  double radius;
};
constexpr std::array<Tree, 3> kTrees = {
    {{{-5.4, 10.6}, 5.2, 2.1}, {{7.9, -1.6}, 3.2, 1.6}, {{8.6, 8.6}, 4.6, 2.1}}};
constexpr double kLeafCell = 0.385;

modelling::PolygonMesh trunk(const Tree& tree, const modelling::Field& leaves) {
  const double top = tree.height - 0.6 * tree.radius;
  const std::vector<glm::dvec3> path = {{tree.place, 0.0},
                                        {tree.place, 0.3},
                                        {tree.place + glm::dvec2(0.1, -0.06), 0.5 * top},
                                        {tree.place, top}};
  const std::vector<double> radii = {0.36, 0.25, 0.20, 0.17};
  return modelling::outside(modelling::tube(path, radii, 10), leaves);
}

void add_trees(SceneBuilder& builder) {
  const Surface bark = {.color = {0.40F, 0.29F, 0.20F}, .diffuse = 0.9F};
  modelling::PolygonMesh leaves;
  for (std::size_t i = 0; i < kTrees.size(); ++i) {
    const Tree& tree = kTrees[i];
    const glm::dvec3 center(tree.place, tree.height);
    const modelling::Field field = crown(center, tree.radius, i + 1);
    builder.set_surface(bark);
    modelling::add_smooth(builder, trunk(tree, field));
    const glm::dvec3 reach(1.5 * tree.radius);
    modelling::append(
        leaves, modelling::implicit_surface(field, center - reach, center + reach, kLeafCell));
  }
  builder.set_surface({.color = {0.26F, 0.54F, 0.20F}, .diffuse = 0.9F});
  modelling::add_smooth(builder, modelling::subdivided_to(modelling::triangulated(leaves),
                                                          kPolygons - builder.primitive_count()));
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {-11.0F, -18.0F, 7.0F},
                      .at = {0.3F, 0.6F, 2.9F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .angle = 44.0F});
  builder.set_background({0.58, 0.79, 0.96});
  builder.add_light({-20.0, -30.0, 30.0}, glm::dvec3(0.95));
  builder.add_light({30.0, -20.0, 15.0}, glm::dvec3(0.35));

  add_ground(builder);
  add_country_house(builder);
  builder.set_surface({.color = {0.95F, 0.94F, 0.90F}, .diffuse = 0.9F});
  modelling::add_flat(builder, fence());
  add_trees(builder);
  return std::move(builder).build();
}

}  // namespace

void register_casa_de_campo(Catalogue& catalogue) {
  catalogue.add({"casa-de-campo",
                 "The thesis's Casa de Campo: a country house of 12,172 polygons in its garden",
                 {},
                 generate});
}

}  // namespace beambench::scenes::generators

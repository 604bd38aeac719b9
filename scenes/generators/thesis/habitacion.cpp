#include <algorithm>
#include <array>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "scenes/catalogue.hpp"
#include "scenes/generators/thesis/room/room.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/modelling/subdivide.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr std::size_t kPolygons = 34110;
constexpr double kCell = 0.0458;  // cell size of the upholstery

constexpr modelling::Rectangle kRug = {{0.80, 2.70}, {3.40, 4.55}};
constexpr glm::dvec3 kCoffeeTable = {1.95, 3.72, 0.012};  // on the rug
constexpr glm::dvec3 kDiningTable = {3.25, 2.20, 0.0};
constexpr glm::dvec3 kShelf = {3.22, kRoom.y, 0.0};
constexpr Settee kSofa = {2.05, 2};
constexpr Settee kArmchair = {1.00, 1};
constexpr glm::dvec3 kSofaAt = {1.90, 5.22, 0.0};
constexpr glm::dvec3 kArmchairAt = {3.42, 4.15, 0.0};
constexpr double kArmchairTurn = -72.0;

/// Return transforms from (across, up, inward) to places on the walls with pictures.
glm::dmat4 hung_at_window_wall(double x, double z) {
  return glm::translate(glm::dmat4(1.0), glm::dvec3(x, kRoom.y, z)) * modelling::rotation(0, 90.0);
}
glm::dmat4 hung_at_door_wall(double y, double z) {
  return glm::translate(glm::dmat4(1.0), glm::dvec3(kRoom.x, y, z)) *
         modelling::rotation(2, -90.0) * modelling::rotation(0, 90.0);
}

void add_furniture(SceneBuilder& builder) {
  add_bookshelf(builder, standing_at(kShelf));
  add_dining_table(builder, standing_at(kDiningTable, 10.0));
  add_coffee_table(builder, standing_at(kCoffeeTable));
  add_chair(builder, standing_at(kDiningTable + glm::dvec3(-0.66, 0.10, 0.0), 82.0));
  add_chair(builder, standing_at(kDiningTable + glm::dvec3(0.14, 0.70, 0.0), -10.0));
  add_chair(builder, standing_at(kDiningTable + glm::dvec3(0.72, -0.05, 0.0), -96.0));
  add_hanging_lamp(builder, kDiningTable + glm::dvec3(0.0, 0.0, 1.66), kRoom.z);
  add_floor_lamp(builder, {0.48, 5.25, 0.0});
}

void add_things(SceneBuilder& builder) {
  const glm::dmat4 coffee = standing_at(kCoffeeTable + glm::dvec3(0.0, 0.0, kCoffeeTop));
  add_china_teapot(builder, coffee * standing_at({-0.08, 0.06, 0.0}, 25.0));
  add_cup(builder, coffee * standing_at({0.14, -0.10, 0.0}, -35.0));
  add_cup(builder, coffee * standing_at({-0.32, -0.08, 0.0}, 190.0));
  const glm::dmat4 books = coffee * standing_at({0.40, 0.08, 0.0}, 12.0);
  add_lying_book(builder, books, {0.24, 0.17, 0.032}, {0.15F, 0.38F, 0.26F});
  add_lying_book(builder, books * standing_at({0.01, 0.01, 0.0322}, -20.0), {0.20, 0.14, 0.026},
                 {0.66F, 0.16F, 0.13F});
  const glm::dmat4 dining = standing_at(kDiningTable + glm::dvec3(0.0, 0.0, kDiningTop));
  add_fruit_bowl(builder, dining * standing_at({-0.17, -0.05, 0.0}));
  add_vase_of_flowers(builder, dining * standing_at({0.17, 0.16, 0.0}));
  add_cup(builder, dining * standing_at({0.20, -0.26, 0.0}, -60.0));
}

void add_decoration(SceneBuilder& builder) {
  add_triangle_picture(builder, hung_at_window_wall(0.14, 1.73));
  add_boat_picture(builder, hung_at_door_wall(5.52, 1.45));
  add_clock(builder, hung_at_window_wall(3.84, 2.40));
  add_potted_plant(builder, {4.70, 5.00, 0.0});
}

/// Returns the cushion without the parts that are inside the sofa or lie against it.
modelling::PolygonMesh not_leaning(modelling::PolygonMesh cushion) {
  const modelling::Field sofa = [](const glm::dvec3& p) {
    return settee_field(p - kSofaAt, kSofa);
  };
  cushion = modelling::outside(cushion, sofa);
  modelling::PolygonMesh seen;
  for (std::size_t i = 0; i < cushion.size(); ++i) {
    const bool looks_back = modelling::area_normal(cushion, cushion.polygons[i]).y > 0.0;
    if (looks_back && sofa(modelling::middle(cushion, i)) < 0.12) continue;
    seen.polygons.push_back(cushion.polygons[i]);
  }
  seen.vertices = std::move(cushion.vertices);
  return seen;
}

modelling::PolygonMesh scatter_cushions() {
  modelling::PolygonMesh cushions;
  for (const double side : {-1.0, 1.0}) {
    const glm::dmat4 place = standing_at(kSofaAt + glm::dvec3(0.62 * side, 0.0, 0.69)) *
                             modelling::rotation(2, -14.0 * side) * modelling::rotation(0, 66.0) *
                             modelling::rotation(2, 45.0 * 0.12);
    const modelling::PolygonMesh cushion =
        modelling::transformed(scatter_cushion(0.21, 0.075, 14), place);
    modelling::append(cushions, not_leaning(cushion));
  }
  return cushions;
}

/// Returns the sofa without its back, which is against the wall.
modelling::PolygonMesh without_back(modelling::PolygonMesh sofa) {
  modelling::PolygonMesh seen;
  for (std::size_t i = 0; i < sofa.size(); ++i) {
    const glm::dvec3 normal = modelling::area_normal(sofa, sofa.polygons[i]);
    const bool looks_back = normal.y > 2.0 * std::max(std::abs(normal.x), std::abs(normal.z));
    if (!looks_back || modelling::middle(sofa, i).y < 0.38)
      seen.polygons.push_back(sofa.polygons[i]);
  }
  seen.vertices = std::move(sofa.vertices);
  return seen;
}

void add_upholstery(SceneBuilder& builder) {
  const glm::dmat4 sofa_place = standing_at(kSofaAt);
  const glm::dmat4 armchair_place = standing_at(kArmchairAt, kArmchairTurn);
  const Surface wood = {
      .color = {0.36F, 0.21F, 0.12F}, .diffuse = 0.85F, .specular = 0.3F, .shine = 30.0F};
  PlacedPiece(builder, sofa_place).smooth(wood, settee_feet(kSofa));
  PlacedPiece(builder, armchair_place).smooth(wood, settee_feet(kArmchair));
  builder.set_surface({.color = {0.92F, 0.70F, 0.28F}, .diffuse = 0.9F});
  modelling::add_smooth(builder, scatter_cushions(), {.crease = 70.0});

  PlacedPiece(builder, armchair_place)
      .smooth({.color = {0.72F, 0.28F, 0.22F}, .diffuse = 0.9F}, settee(kArmchair, kCell), 60.0);
  const modelling::PolygonMesh sofa = modelling::subdivided_to(
      without_back(settee(kSofa, kCell)), kPolygons - builder.primitive_count());
  PlacedPiece(builder, sofa_place)
      .smooth({.color = {0.22F, 0.46F, 0.50F}, .diffuse = 0.9F}, sofa, 60.0);
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {1.15F, 0.25F, 1.66F},
                      .at = {2.70F, 4.00F, 0.98F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .angle = 66.0F});
  builder.add_light({2.2, 2.1, 2.0}, glm::dvec3(1.0));
  builder.add_light({0.6, 0.5, 1.5}, glm::dvec3(0.6));
  builder.add_light({0.48, 5.1, 1.9}, {0.55, 0.48, 0.36});

  const std::array<modelling::Rectangle, 2> covered = {
      kRug,
      modelling::Rectangle{{kShelf.x, kRoom.y - kBookshelf.y}, {kShelf.x + kBookshelf.x, kRoom.y}}};
  add_room(builder, covered);
  add_rug(builder, kRug);
  add_curtains(builder, kWindow, kRoom.y - 0.14);
  add_furniture(builder);
  add_things(builder);
  add_decoration(builder);
  add_upholstery(builder);
  return std::move(builder).build();
}

}  // namespace

void register_habitacion(Catalogue& catalogue) {
  catalogue.add(
      {"habitacion",
       "The thesis's Habitacion: a furnished closed room of 34,110 polygons, seen from inside",
       {},
       generate});
}

}  // namespace beambench::scenes::generators

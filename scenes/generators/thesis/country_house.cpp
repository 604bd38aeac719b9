#include "scenes/generators/thesis/country_house.hpp"

#include <algorithm>
#include <array>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/generators/thesis/tiled_roof.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/box.hpp"
#include "scenes/modelling/lattice_work.hpp"
#include "scenes/modelling/recessed.hpp"
#include "scenes/modelling/square_ring.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kWallTop = 5.0;
constexpr double kRidge = 7.5;
constexpr double kRecess = 0.18;
constexpr glm::dvec2 kWindow = {1.2, 1.4};
constexpr glm::dvec2 kDoor = {1.3, 2.2};
constexpr glm::dvec2 kDoorAt = {4.35, 0.2};  // on the front wall
constexpr glm::dvec2 kChimney = {3.0, 5.0};
constexpr double kChimneyHalf = 0.45;

const Surface kPlaster = {.color = {0.95F, 0.90F, 0.78F}, .diffuse = 0.9F};
const Surface kTiles = {.color = {0.75F, 0.34F, 0.20F}, .diffuse = 0.9F};
const Surface kWood = {.color = {0.42F, 0.26F, 0.15F}, .diffuse = 0.9F};
const Surface kPaint = {.color = {0.16F, 0.42F, 0.36F}, .diffuse = 0.9F};
const Surface kFrame = {.color = {0.97F, 0.96F, 0.93F}, .diffuse = 0.9F};
const Surface kStone = {.color = {0.66F, 0.62F, 0.56F}, .diffuse = 0.9F};
const Surface kGlass = {
    .color = {0.25F, 0.38F, 0.50F}, .diffuse = 0.6F, .specular = 0.6F, .shine = 60.0F};

/// A wall of the house: `place` takes (across, up, outward) to the scene.
struct Wall {
  glm::dmat4 place;
  double width;
  std::vector<glm::dvec2> windows;  ///< lower left corners
};

glm::dmat4 standing(const glm::dvec3& corner, const glm::dvec3& across) {
  const glm::dvec3 up(0.0, 0.0, 1.0);
  return {glm::dvec4(across, 0.0), glm::dvec4(up, 0.0), glm::dvec4(glm::cross(across, up), 0.0),
          glm::dvec4(corner, 1.0)};
}

glm::dmat4 moved(const glm::dmat4& place, const glm::dvec2& to, double out = 0.0) {
  return glm::translate(place, glm::dvec3(to, out));
}

std::array<Wall, 4> walls() {
  return {{{standing({-5.0, 0.0, 0.0}, {1.0, 0.0, 0.0}),
            10.0,
            {{1.3, 0.9}, {7.5, 0.9}, {1.3, 3.2}, {4.4, 3.2}, {7.5, 3.2}}},
           {standing({5.0, 0.0, 0.0}, {0.0, 1.0, 0.0}), 7.0, {{2.9, 0.9}, {2.9, 3.2}}},
           {standing({5.0, 7.0, 0.0}, {-1.0, 0.0, 0.0}),
            10.0,
            {{1.6, 0.9}, {7.2, 0.9}, {1.6, 3.2}, {7.2, 3.2}}},
           {standing({-5.0, 7.0, 0.0}, {0.0, -1.0, 0.0}), 7.0, {{2.9, 0.9}, {2.9, 3.2}}}}};
}

void add(SceneBuilder& builder, const Surface& surface, const modelling::PolygonMesh& mesh,
         const glm::dmat4& place) {
  builder.set_surface(surface);
  modelling::add_flat(builder, modelling::transformed(mesh, place));
}

/// A shutter with slats, hung beside a window.
void add_shutter(SceneBuilder& builder, const glm::dmat4& place) {
  constexpr double kThick = 0.06;
  constexpr int kSlats = 9;
  const glm::dvec2 size(0.5 * kWindow.x, kWindow.y);
  const std::vector<modelling::Rectangle> opening = modelling::panes(size, 1, 1, 0.07);
  modelling::PolygonMesh mesh =
      modelling::transformed(modelling::recessed(size, opening, kThick),
                             glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, kThick)));
  modelling::PolygonMesh edges = modelling::box({0.0, 0.0, 0.0}, {size, kThick});
  edges.polygons.resize(4);  // without back and front
  modelling::append(mesh, edges);
  const auto& [lower, upper] = opening.front();
  for (int i = 0; i < kSlats; ++i) {
    const double y = lower.y + (i + 0.5) * (upper.y - lower.y) / kSlats;
    modelling::append(
        mesh, modelling::bar({lower.x, y, 0.03}, {upper.x, y, 0.03}, {0.0, 1.0, 1.0}, 0.035));
  }
  add(builder, kPaint, mesh, place);
}

void add_window(SceneBuilder& builder, const glm::dmat4& place) {
  const std::vector<modelling::Rectangle> glass = modelling::panes(kWindow, 2, 3, 0.08);
  const glm::dmat4 inside = moved(place, {0.0, 0.0}, -kRecess);
  add(builder, kFrame, modelling::recessed(kWindow, glass, 0.05), inside);
  add(builder, kGlass, modelling::openings_filled(glass, 0.05), inside);
  const modelling::PolygonMesh sill =
      modelling::box_without_bottom({-0.1, -0.1, 0.0}, {kWindow.x + 0.1, -0.005, 0.16});
  add(builder, kStone, sill, place);
  add_shutter(builder, moved(place, {-0.03 - 0.5 * kWindow.x, 0.0}));
  add_shutter(builder, moved(place, {kWindow.x + 0.03, 0.0}));
}

void add_door(SceneBuilder& builder, const glm::dmat4& place) {
  const std::vector<modelling::Rectangle> panels = modelling::panes(kDoor, 2, 3, 0.12);
  const glm::dmat4 inside = moved(place, kDoorAt, -kRecess);
  add(builder, kWood, modelling::recessed(kDoor, panels, 0.04), inside);
  add(builder, kWood, modelling::openings_filled(panels, 0.04), inside);
  const modelling::PolygonMesh knob =
      modelling::bevelled_box({1.15, 1.0, 0.0}, {1.23, 1.08, 0.08}, 0.025);
  add(builder, kFrame, knob, inside);
}

void add_walls(SceneBuilder& builder) {
  bool is_front = true;
  for (const Wall& wall : walls()) {
    std::vector<modelling::Rectangle> openings;
    for (const glm::dvec2& at : wall.windows) openings.push_back({at, at + kWindow});
    if (is_front) openings.push_back({kDoorAt, kDoorAt + kDoor});
    add(builder, kPlaster, modelling::recessed({wall.width, kWallTop}, openings, kRecess),
        wall.place);
    for (const glm::dvec2& at : wall.windows) add_window(builder, moved(wall.place, at));
    if (is_front) add_door(builder, wall.place);
    is_front = false;
  }
  modelling::PolygonMesh gables;
  gables.vertices = {{5.0, 0.0, kWallTop},  {5.0, 7.0, kWallTop},  {5.0, 3.5, kRidge},
                     {-5.0, 7.0, kWallTop}, {-5.0, 0.0, kWallTop}, {-5.0, 3.5, kRidge}};
  gables.polygons = {{0, 1, 2}, {3, 4, 5}};
  add(builder, kPlaster, gables, glm::dmat4(1.0));
}

/// Without what is under the chimney.
modelling::PolygonMesh around_chimney(modelling::PolygonMesh roof) {
  std::erase_if(roof.polygons, [&](const modelling::PolygonMesh::Corners& corners) {
    return std::all_of(corners.begin(), corners.end(), [&](std::uint32_t corner) {
      const glm::dvec2 off = glm::abs(glm::dvec2(roof.vertices[corner]) - kChimney);
      return std::max(off.x, off.y) < kChimneyHalf;
    });
  });
  return roof;
}

void add_roof(SceneBuilder& builder) {
  // The eaves hang half a meter over the walls, the tiles lie a hand above the gables.
  const double rise = (kRidge - kWallTop) / 3.5;
  const double lift = 0.12;
  const glm::dvec3 ridge(0.0, 3.5, kRidge + lift);
  const glm::dvec3 run(0.0, 4.1, 4.1 * rise);
  constexpr int kAlong = 27;
  constexpr int kRows = 11;
  modelling::PolygonMesh roof =
      tiled_slope({glm::dvec3(-5.6, 0.0, 0.0) + ridge - run, {11.2, 0.0, 0.0}, run, kAlong, kRows});
  const glm::dvec3 back(0.0, -run.y, run.z);
  modelling::append(
      roof,
      tiled_slope(
          {glm::dvec3(5.6, 0.0, 0.0) + ridge - back, {-11.2, 0.0, 0.0}, back, kAlong, kRows}));
  modelling::append(roof,
                    ridge_tiles({-5.62, 3.5, kRidge + 0.06}, {5.62, 3.5, kRidge + 0.06}, 0.28, 22));
  builder.set_surface(kTiles);
  modelling::add_flat(builder, around_chimney(std::move(roof)));
}

void add_chimney(SceneBuilder& builder) {
  const glm::dmat4 place = glm::translate(glm::dmat4(1.0), glm::dvec3(kChimney, 0.0));
  modelling::PolygonMesh shaft =
      modelling::box({-kChimneyHalf, -kChimneyHalf, 5.9}, {kChimneyHalf, kChimneyHalf, 8.1});
  shaft.polygons.resize(4);  // open below and, in the cap, above
  add(builder, kPlaster, shaft, place);
  add(builder, kStone, modelling::square_ring(kChimneyHalf + 0.12, 0.25, 8.1, 8.35), place);
}

void add_porch(SceneBuilder& builder) {
  builder.set_surface(kStone);
  modelling::add_flat(builder,
                      modelling::box_without_bottom({-2.0, -2.0, 0.0}, {2.0, -0.001, 0.2}));
  modelling::add_flat(builder,
                      modelling::box_without_bottom({-0.9, -2.4, 0.0}, {0.9, -2.001, 0.1}));
  modelling::PolygonMesh posts;
  for (const double x : {-1.75, 1.75}) {
    modelling::append(posts,
                      modelling::bar({x, -1.75, 0.2}, {x, -1.75, 2.47}, {0.0, 1.0, 0.0}, 0.2));
    modelling::append(posts,
                      modelling::bar({x, -1.65, 2.0}, {x, -1.2, 2.56}, {1.0, 0.0, 0.0}, 0.1));
  }
  modelling::append(posts,
                    modelling::bar({-2.1, -1.75, 2.5}, {2.1, -1.75, 2.5}, {0.0, 1.0, 0.0}, 0.16));
  builder.set_surface(kWood);
  modelling::add_flat(builder, posts);
  builder.set_surface(kTiles);
  modelling::add_flat(builder,
                      tiled_slope({{-2.25, -2.3, 2.5}, {4.5, 0.0, 0.0}, {0.0, 2.3, 0.5}, 12, 6}));
}

}  // namespace

void add_country_house(SceneBuilder& builder) {
  add_walls(builder);
  add_roof(builder);
  add_chimney(builder);
  add_porch(builder);
}

}  // namespace beambench::scenes::generators

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/base/portable_math.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/box.hpp"
#include "scenes/modelling/extrusion.hpp"
#include "scenes/modelling/implicit_surface.hpp"
#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/modelling/subdivide.hpp"
#include "scenes/modelling/sweep.hpp"
#include "scenes/modelling/walls.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

/// A slope of the roof: from an eaves corner along the eaves and up to the ridge.
struct RoofSlope {
  glm::dvec3 corner;
  glm::dvec3 along;  ///< from one end of the eaves to the other; along x up points outward
  glm::dvec3 up;     ///< from the eaves up to the ridge
  int tiles;         ///< number of tiles along the eaves
  int rows;
};

constexpr int kPieces = 6;  // quads around a tile and the channel beside it

/// Adds a strip of quads between two lines with equal numbers of points.
void add_strip(modelling::PolygonMesh& mesh, const std::vector<glm::dvec3>& low,
               const std::vector<glm::dvec3>& high) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto count = static_cast<std::uint32_t>(low.size());
  mesh.vertices.insert(mesh.vertices.end(), low.begin(), low.end());
  mesh.vertices.insert(mesh.vertices.end(), high.begin(), high.end());
  for (std::uint32_t i = 0; i + 1 < count; ++i) {
    mesh.polygons.push_back({first + i, first + i + 1, first + count + i + 1, first + count + i});
  }
}

/// Returns rows of round tiles, each row lying on the one below: six quads per tile.
modelling::PolygonMesh tiled_slope(const RoofSlope& slope) {
  const glm::dvec3 outward = glm::normalize(glm::cross(slope.along, slope.up));
  const double width = glm::length(slope.along) / slope.tiles;
  const double overlap = 0.35 / slope.rows;
  modelling::PolygonMesh mesh;
  for (int row = 0; row < slope.rows; ++row) {
    const double start = static_cast<double>(row) / slope.rows;
    const double end =
        static_cast<double>(row + 1) / slope.rows + (row + 1 < slope.rows ? overlap : 0.0);
    std::vector<glm::dvec3> low;
    std::vector<glm::dvec3> high;
    for (int i = 0; i <= kPieces * slope.tiles; ++i) {
      const double share = static_cast<double>(i) / (kPieces * slope.tiles);
      const double wave = -portable_cos(2.0 * std::numbers::pi * i / kPieces);
      const glm::dvec3 place = slope.corner + share * slope.along + 0.22 * width * wave * outward;
      low.push_back(place + start * slope.up + 0.06 * width * outward);
      high.push_back(place + end * slope.up);
    }
    add_strip(mesh, low, high);
  }
  return mesh;
}

/// Returns the round tiles that cover a ridge.
modelling::PolygonMesh ridge_tiles(const glm::dvec3& from, const glm::dvec3& to, double radius,
                                   int tiles) {
  const glm::dvec3 along = to - from;
  const glm::dvec3 up(0.0, 0.0, 1.0);
  const glm::dvec3 aside = glm::normalize(glm::cross(along, up));
  const auto arc = [&](double share, double size) {
    std::vector<glm::dvec3> places;
    for (int i = 0; i <= kPieces; ++i) {
      const double angle = std::numbers::pi * i / kPieces;
      places.push_back(from + share * along +
                       size * (portable_cos(angle) * aside + portable_sin(angle) * up));
    }
    return places;
  };
  modelling::PolygonMesh mesh;
  for (int i = 0; i < tiles; ++i) {
    const double start = static_cast<double>(i) / tiles;
    const double end = std::min(1.0, (i + 1.1) / tiles);
    add_strip(mesh, arc(end, 0.92 * radius), arc(start, radius));
  }
  return mesh;
}

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

/// A wall of the house: `place` maps (across, up, outward) to the scene.
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

/// Adds a shutter with slats, mounted beside a window.
void add_shutter(SceneBuilder& builder, const glm::dmat4& place) {
  constexpr double kThick = 0.06;
  constexpr int kSlats = 9;
  const glm::dvec2 size(0.5 * kWindow.x, kWindow.y);
  const std::vector<modelling::Rectangle> opening = modelling::panes(size, 1, 1, 0.07);
  modelling::PolygonMesh mesh =
      modelling::transformed(modelling::recessed(size, opening, kThick),
                             glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, kThick)));
  modelling::PolygonMesh edges = modelling::box({0.0, 0.0, 0.0}, {size, kThick});
  edges.polygons.resize(4);  // removes the back and the front
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
      modelling::beveled_box({1.15, 1.0, 0.0}, {1.23, 1.08, 0.08}, 0.025);
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

/// Returns the roof without the part under the chimney.
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
  // The eaves overhang the walls by half a meter, and the tiles lie a hand above the gables.
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

/// Adds the house: 10 wide (x from -5), 7 deep (y from 0, the front), with the ridge 7.6 high and a
/// porch in front of the door on [-2, 2] x [-2, 0].
void add_country_house(SceneBuilder& builder) {
  add_walls(builder);
  add_roof(builder);
  add_chimney(builder);
  add_porch(builder);
}

constexpr std::size_t kPolygons = 12172;

/// Adds squares of meadow and of the path to the door, except under the house and its porch.
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

/// Returns pickets with rails behind them along y = -7.6, open where the path goes through.
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

/// Returns a crown of clumps of leaves around a place.
modelling::Field crown(const glm::dvec3& center, double radius, std::uint64_t seed) {
  struct Clump {
    glm::dvec3 center;
    double radius;
  };
  std::vector<Clump> clumps = {{center, radius}};
  Random random(seed);
  while (clumps.size() < 26) {
    // The numbers are drawn one by one, because compilers evaluate arguments in different orders.
    const double z = random.uniform(-0.8, 1.0);
    const double y = random.uniform(-1.0, 1.0);
    const glm::dvec3 way(random.uniform(-1.0, 1.0), y, z);
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
  double height;  ///< height of the crown's center
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

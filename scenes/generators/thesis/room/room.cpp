#include "scenes/generators/thesis/room/room.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/base/portable_math.hpp"
#include "scenes/base/random.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/box.hpp"
#include "scenes/modelling/extrusion.hpp"
#include "scenes/modelling/lathe.hpp"
#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/modelling/walls.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kReveal = 0.22;  // depth of the window's opening
constexpr double kDoorReveal = 0.06;
constexpr modelling::Rectangle kDoor = {{1.25, 0.0}, {2.10, 2.08}};  // on the wall x = kRoom.x

const Surface kPlaster = {.color = {0.95F, 0.89F, 0.76F}, .diffuse = 0.9F};
const Surface kWhite = {.color = {0.97F, 0.96F, 0.93F}, .diffuse = 0.9F};
const Surface kPaintedWood = {
    .color = {0.96F, 0.95F, 0.91F}, .diffuse = 0.9F, .specular = 0.25F, .shine = 30.0F};
const Surface kBrass = {
    .color = {0.80F, 0.63F, 0.28F}, .diffuse = 0.8F, .specular = 0.7F, .shine = 50.0F};

/// Returns the transform from a wall's (across, up, inward) to the room.
glm::dmat4 wall(const glm::dvec3& corner, const glm::dvec3& across) {
  const glm::dvec3 up(0.0, 0.0, 1.0);
  return {glm::dvec4(across, 0.0), glm::dvec4(up, 0.0), glm::dvec4(glm::cross(across, up), 0.0),
          glm::dvec4(corner, 1.0)};
}
glm::dmat4 window_wall() { return wall({0.0, kRoom.y, 0.0}, {1.0, 0.0, 0.0}); }
glm::dmat4 door_wall() { return wall({kRoom.x, kRoom.y, 0.0}, {0.0, -1.0, 0.0}); }

glm::dmat4 moved(const glm::dmat4& place, const glm::dvec2& to, double out) {
  return glm::translate(place, glm::dvec3(to, out));
}

bool within(const modelling::Rectangle& inner, const modelling::Rectangle& outer) {
  return outer.lower.x <= inner.lower.x && inner.upper.x <= outer.upper.x &&
         outer.lower.y <= inner.lower.y && inner.upper.y <= outer.upper.y;
}

/// Adds oak boards along y in four shades, with staggered joints.
void add_floor(SceneBuilder& builder, std::span<const modelling::Rectangle> covered) {
  constexpr int kRows = 40;
  constexpr std::array<glm::vec3, 4> kShades = {
      {{0.66F, 0.45F, 0.26F}, {0.61F, 0.40F, 0.22F}, {0.70F, 0.49F, 0.29F}, {0.57F, 0.38F, 0.21F}}};
  Random random(7);
  for (int row = 0; row < kRows; ++row) {
    const double left = kRoom.x * row / kRows;
    const double right = kRoom.x * (row + 1) / kRows;
    double y = 0.0;
    double end = random.uniform(0.35, 1.3);
    while (y < kRoom.y) {
      if (kRoom.y - end < 0.4) end = kRoom.y;
      const glm::vec3 shade = kShades[random.below(kShades.size())];
      const modelling::Rectangle board = {{left, y}, {right, end}};
      const bool is_hidden =
          std::any_of(covered.begin(), covered.end(),
                      [&](const modelling::Rectangle& r) { return within(board, r); });
      if (!is_hidden) {
        builder.set_surface({.color = shade, .diffuse = 0.9F, .specular = 0.3F, .shine = 35.0F});
        const std::array<glm::dvec3, 4> corners = {
            {{left, y, 0.0}, {right, y, 0.0}, {right, end, 0.0}, {left, end, 0.0}}};
        builder.add_polygon(corners);
      }
      y = end;
      end = y + random.uniform(0.9, 1.6);
    }
  }
}

void add_walls(SceneBuilder& builder) {
  const std::array<modelling::Rectangle, 1> window = {kWindow};
  const std::array<modelling::Rectangle, 1> door = {kDoor};
  PlacedPiece(builder, window_wall())
      .flat(kPlaster, modelling::recessed({kRoom.x, kRoom.z}, window, kReveal));
  PlacedPiece(builder, door_wall())
      .flat(kPlaster, modelling::recessed({kRoom.y, kRoom.z}, door, kDoorReveal));
  PlacedPiece(builder, wall({kRoom.x, 0.0, 0.0}, {-1.0, 0.0, 0.0}))
      .flat(kPlaster, modelling::recessed({kRoom.x, kRoom.z}, {}, 0.0));
  PlacedPiece(builder, wall({0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}))
      .flat(kPlaster, modelling::recessed({kRoom.y, kRoom.z}, {}, 0.0));
  builder.set_surface(kWhite);
  const std::array<glm::dvec3, 4> ceiling = {
      {{0.0, 0.0, kRoom.z}, {0.0, kRoom.y, kRoom.z}, kRoom, {kRoom.x, 0.0, kRoom.z}}};
  builder.add_polygon(ceiling);
}

void add_skirting_and_cornice(SceneBuilder& builder) {
  constexpr double kArchitrave = 0.09;
  PlacedPiece room(builder, glm::dmat4(1.0));
  const std::vector<glm::dvec2> skirting = {
      {0.0, 0.12}, {0.010, 0.12}, {0.018, 0.10}, {0.018, 0.0}};
  room.flat(kPaintedWood, modelling::without_side(modelling::molding(kRoom, skirting), 1));
  // On the door's wall, the skirting stops at both sides of the architrave.
  const std::array<modelling::Rectangle, 2> pieces = {
      {{{0.018, 0.0}, {kDoor.lower.x - kArchitrave, 0.12}},
       {{kDoor.upper.x + kArchitrave, 0.0}, {kRoom.y - 0.018, 0.12}}}};
  for (const modelling::Rectangle& piece : pieces) {
    modelling::PolygonMesh board = modelling::box({piece.lower, 0.0}, {piece.upper, 0.018});
    board.polygons = {board.polygons[3], board.polygons[5]};  // top and front
    PlacedPiece(builder, door_wall()).flat(kPaintedWood, board);
  }
  const std::vector<glm::dvec2> cornice = {{0.11, kRoom.z},         {0.10, kRoom.z - 0.015},
                                           {0.060, kRoom.z - 0.03}, {0.030, kRoom.z - 0.060},
                                           {0.015, kRoom.z - 0.10}, {0.0, kRoom.z - 0.11}};
  room.flat(kWhite, modelling::molding(kRoom, cornice));
}

using Line = std::vector<glm::dvec2>;

/// Returns a line of hills from the left edge to the right one.
Line hills(const glm::dvec2& size, double height, double swing, double phase) {
  constexpr int kPieces = 24;
  Line line;
  for (int i = 0; i <= kPieces; ++i) {
    const double x = static_cast<double>(i) / kPieces;
    const double rise = portable_sin(5.3 * x + phase) + 0.4 * portable_sin(12.1 * x + 2.0 * phase);
    line.emplace_back(size.x * x, size.y * (height + swing * rise));
  }
  return line;
}

Line level(const glm::dvec2& size, double height) {
  return {{0.0, size.y * height}, {size.x, size.y * height}};
}

/// Returns the polygons between two lines.
modelling::PolygonMesh between(const Line& low, const Line& high) {
  Line outline = low;
  outline.insert(outline.end(), high.rbegin(), high.rend());
  modelling::PolygonMesh mesh;
  const modelling::FlatShape shape = modelling::flat_polygon(outline);
  for (const glm::dvec2& point : shape.points) mesh.vertices.emplace_back(point, 0.0);
  mesh.polygons = shape.polygons;
  return mesh;
}

/// Closes the rectangle from (0, 0) to `size` in the plane z = 0 of `place` with a landscape (sky,
/// distant hills and a meadow), all in that plane.
void add_window_view(SceneBuilder& builder, const glm::dmat4& place, const glm::dvec2& size) {
  const std::array<Line, 6> lines = {level(size, 0.0),
                                     hills(size, 0.24, 0.05, 0.6),
                                     hills(size, 0.42, 0.06, 2.4),
                                     level(size, 0.62),
                                     level(size, 0.80),
                                     level(size, 1.0)};
  constexpr std::array<glm::vec3, 5> kColors = {{{0.52F, 0.74F, 0.36F},
                                                 {0.45F, 0.63F, 0.52F},
                                                 {0.87F, 0.95F, 1.0F},
                                                 {0.76F, 0.90F, 1.0F},
                                                 {0.64F, 0.84F, 1.0F}}};
  PlacedPiece view(builder, place);
  for (std::size_t i = 0; i < kColors.size(); ++i) {
    view.flat({.color = kColors[i], .diffuse = 1.0F}, between(lines[i], lines[i + 1]));
  }
}

void add_window(SceneBuilder& builder) {
  const glm::dvec2 size = kWindow.upper - kWindow.lower;
  add_window_view(builder, moved(window_wall(), kWindow.lower, -kReveal), size);

  // Two casements, whose backs are never visible.
  const glm::dvec2 half(0.5 * size.x, size.y);
  const std::vector<modelling::Rectangle> openings = modelling::panes(half, 2, 3, 0.045);
  for (const double x : {0.0, half.x}) {
    PlacedPiece(builder, moved(window_wall(), kWindow.lower + glm::dvec2(x, 0.0), -0.12))
        .flat(kPaintedWood, modelling::recessed(half, openings, 0.04));
  }
  PlacedPiece front(builder, moved(window_wall(), kWindow.lower, 0.0));
  front.flat(kBrass, modelling::beveled_box({half.x - 0.012, 0.52, -0.115},
                                            {half.x + 0.012, 0.66, -0.085}, 0.006));
  front.flat(kPaintedWood,
             modelling::beveled_box({-0.08, -0.045, -0.005}, {size.x + 0.08, -0.003, 0.075}, 0.01));
}

void add_door(SceneBuilder& builder) {
  const glm::dvec2 size = kDoor.upper - kDoor.lower;
  const std::vector<modelling::Rectangle> panels = modelling::panes(size, 2, 3, 0.11);
  PlacedPiece leaf(builder, moved(door_wall(), kDoor.lower, -kDoorReveal));
  leaf.flat(kPaintedWood, modelling::recessed(size, panels, 0.025));
  leaf.flat(kPaintedWood, modelling::openings_filled(panels, 0.025));
  for (const modelling::Rectangle& panel : panels) {  // each panel is raised in its middle
    const std::vector<glm::dvec2> raised = {{0.03, -0.025}, {0.05, -0.008}};
    modelling::PolygonMesh field = modelling::molding(panel.upper - panel.lower, raised);
    field.polygons.push_back({4, 5, 6, 7});
    PlacedPiece(builder, moved(door_wall(), kDoor.lower + panel.lower, -kDoorReveal))
        .flat(kPaintedWood, field);
  }
  modelling::Profile knob({0.026, 0.0});
  knob.line({0.026, 0.008})
      .line({0.011, 0.014})
      .curve({0.012, 0.045}, -0.002, 3)
      .ball(0.07, 0.028, 8);
  PlacedPiece(builder, moved(door_wall(), kDoor.lower + glm::dvec2(0.055, 1.0), -kDoorReveal))
      .smooth(kBrass, modelling::lathe(knob.points(), 20));

  constexpr double kWidth = 0.09;
  const std::vector<glm::dvec2> profile = {{0.0, 0.0},    {0.0, 0.028},    {0.012, 0.034},
                                           {0.07, 0.022}, {kWidth, 0.018}, {kWidth, 0.0}};
  modelling::PolygonMesh frame =
      modelling::without_side(modelling::molding(size + 2.0 * kWidth, profile), 0);
  for (glm::dvec3& vertex : frame.vertices) vertex.y = std::max(vertex.y, kWidth);  // the floor
  PlacedPiece(builder, moved(door_wall(), kDoor.lower - kWidth, 0.0)).flat(kPaintedWood, frame);
}

}  // namespace

void add_room(SceneBuilder& builder, std::span<const modelling::Rectangle> covered) {
  add_floor(builder, covered);
  add_walls(builder);
  add_skirting_and_cornice(builder);
  add_window(builder);
  add_door(builder);
}

glm::dmat4 standing_at(const glm::dvec3& place, double degrees) {
  return glm::translate(glm::dmat4(1.0), place) * modelling::rotation(2, degrees);
}

void PlacedPiece::flat(const Surface& surface, const modelling::PolygonMesh& mesh) {
  builder_.set_surface(surface);
  modelling::add_flat(builder_, modelling::transformed(mesh, place_));
}

void PlacedPiece::smooth(const Surface& surface, const modelling::PolygonMesh& mesh,
                         double crease) {
  builder_.set_surface(surface);
  modelling::add_smooth(builder_, modelling::transformed(mesh, place_), {.crease = crease});
}

modelling::PolygonMesh above(modelling::PolygonMesh mesh, double z) {
  std::erase_if(mesh.polygons, [&](const modelling::PolygonMesh::Corners& corners) {
    return std::all_of(corners.begin(), corners.end(),
                       [&](std::uint32_t corner) { return mesh.vertices[corner].z < z; });
  });
  return mesh;
}

}  // namespace beambench::scenes::generators

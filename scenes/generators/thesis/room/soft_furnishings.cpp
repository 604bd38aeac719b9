#include "scenes/generators/thesis/room/soft_furnishings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/common.hpp>

#include "scenes/core/portable_math.hpp"
#include "scenes/generators/thesis/room/placed_piece.hpp"
#include "scenes/modelling/lathe.hpp"
#include "scenes/modelling/parametric_surface.hpp"
#include "scenes/modelling/profile.hpp"
#include "scenes/modelling/rotation.hpp"
#include "scenes/modelling/subdivide.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kPile = 0.012;  // the rug's thickness
constexpr int kKnotsX = 46;
constexpr int kKnotsY = 32;

enum Yarn : std::size_t { kRed, kNavy, kCream, kGold, kYarns };
constexpr std::array<glm::vec3, kYarns> kYarnColors = {
    {{0.62F, 0.16F, 0.14F}, {0.14F, 0.20F, 0.38F}, {0.90F, 0.83F, 0.68F}, {0.80F, 0.58F, 0.24F}}};

/// Borders around a red ground with a stepped medallion in its middle.
Yarn knot(int x, int y) {
  const int edge = std::min({x, y, kKnotsX - 1 - x, kKnotsY - 1 - y});
  if (edge == 0) return kNavy;
  if (edge < 4) return edge == 2 && (x + y) % 4 < 2 ? kGold : kCream;
  if (edge == 4) return kNavy;
  const int dx = std::abs(2 * x - kKnotsX + 1) / 2;
  const int dy = std::abs(2 * y - kKnotsY + 1) / 2;
  const int steps = dx / 2 * 2 + dy * 3 / 2;
  if (steps < 4) return kGold;
  if (steps < 8) return kRed;
  if (steps < 11) return kCream;
  if (steps < 17) return kNavy;
  return steps < 19 ? kGold : kRed;
}

/// One curtain: u from its free edge to the window's side, v upward.
modelling::PolygonMesh curtain(double free_edge, double side, double bottom, double top, double y) {
  constexpr double kTied = 0.34;  // where it is drawn aside
  constexpr int kFolds = 6;
  const auto sheet = [=](double u, double v) {
    const double above_tie = std::max(0.0, v - kTied) / (1.0 - kTied);
    const double below_tie = std::max(0.0, kTied - v) / kTied;
    const double open = v > kTied ? std::lerp(0.42, 1.0, above_tie * above_tie)
                                  : std::lerp(0.42, 0.62, below_tie * (2.0 - below_tie));
    const double angle = 2.0 * std::numbers::pi * kFolds * u;
    const double fold = 0.020 + 0.012 * (1.0 - v);
    return glm::dvec3(
        side + (free_edge - side) * open * (1.0 - u) + 0.006 * portable_sin(2.0 * angle),
        y - fold * portable_sin(angle), std::lerp(bottom, top, v));
  };
  return modelling::triangulated(modelling::parametric_surface(sheet, 48, 12));
}

/// A curtain ring around the rod (x is the rod's axis).
modelling::PolygonMesh ring(const glm::dvec3& center) {
  constexpr double kRing = 0.026;
  constexpr double kWire = 0.004;
  const auto torus = [=](double u, double v) {
    const double around = 2.0 * std::numbers::pi * u;
    const double wire = 2.0 * std::numbers::pi * v;
    const double radius = kRing + kWire * portable_cos(wire);
    return center + glm::dvec3(kWire * portable_sin(wire), radius * portable_cos(around),
                               radius * portable_sin(around));
  };
  return modelling::parametric_surface(torus, 12, 5);
}

modelling::PolygonMesh curtain_rod(double length) {
  modelling::Profile profile({0.0, -0.075});
  profile.curve({0.012, -0.01}, 0.022, 6).line({0.012, length + 0.01});
  profile.curve({0.0, length + 0.075}, 0.022, 6);
  return modelling::lathe(profile.points(), 12);
}

}  // namespace

void add_rug(SceneBuilder& builder, const modelling::Rectangle& place) {
  const glm::dvec2 size = place.upper - place.lower;
  std::array<modelling::PolygonMesh, kYarns> meshes;
  modelling::PolygonMesh grid;
  for (int y = 0; y <= kKnotsY; ++y) {
    for (int x = 0; x <= kKnotsX; ++x) {
      grid.vertices.emplace_back(
          place.lower + size * glm::dvec2(x, y) / glm::dvec2(kKnotsX, kKnotsY), kPile);
    }
  }
  for (modelling::PolygonMesh& mesh : meshes) mesh.vertices = grid.vertices;
  constexpr auto kRow = static_cast<std::uint32_t>(kKnotsX + 1);
  for (int y = 0; y < kKnotsY; ++y) {
    for (int x = 0; x < kKnotsX; ++x) {
      const std::uint32_t at = static_cast<std::uint32_t>(y) * kRow + static_cast<std::uint32_t>(x);
      meshes[knot(x, y)].polygons.push_back({at, at + 1, at + kRow + 1, at + kRow});
    }
  }
  modelling::PolygonMesh edge;
  for (const double z : {0.0, kPile}) {
    edge.vertices.insert(edge.vertices.end(), {{place.lower, z},
                                               {place.upper.x, place.lower.y, z},
                                               {place.upper, z},
                                               {place.lower.x, place.upper.y, z}});
  }
  edge.polygons = {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  modelling::append(meshes[kNavy], edge);
  for (int i = 0; i < 2 * kKnotsY; ++i) {  // threads of the fringe
    const double y = std::lerp(place.lower.y, place.upper.y, (i + 0.5) / (2.0 * kKnotsY));
    for (const auto& [from, to] : {std::pair(place.lower.x, place.lower.x - 0.06),
                                   std::pair(place.upper.x, place.upper.x + 0.06)}) {
      modelling::PolygonMesh thread;
      thread.vertices = {{from, y - 0.007, 0.010},
                         {to, y - 0.004, 0.003},
                         {to, y + 0.004, 0.003},
                         {from, y + 0.007, 0.010}};
      thread.polygons = {{0, 1, 2, 3}};
      modelling::append(meshes[kCream], to < from ? modelling::turned_inside_out(thread) : thread);
    }
  }
  PlacedPiece rug(builder, glm::dmat4(1.0));
  for (std::size_t yarn = 0; yarn < kYarns; ++yarn) {
    rug.flat({.color = kYarnColors[yarn], .diffuse = 0.9F}, meshes[yarn]);
  }
}

void add_curtains(SceneBuilder& builder, const modelling::Rectangle& window, double y) {
  constexpr double kBeside = 0.26;  // of the wall, covered too
  const double bottom = window.lower.y - 0.12;
  const double top = window.upper.y + 0.10;
  const double rod = top + 0.038;
  const Surface cloth = {.color = {0.86F, 0.47F, 0.30F}, .diffuse = 0.9F};
  const Surface brass = {
      .color = {0.80F, 0.63F, 0.28F}, .diffuse = 0.8F, .specular = 0.7F, .shine = 50.0F};
  const double middle = 0.5 * (window.lower.x + window.upper.x);
  PlacedPiece room(builder, glm::dmat4(1.0));
  for (const double side : {-1.0, 1.0}) {
    const double out = middle + side * (middle - window.lower.x + kBeside);
    const double free_edge = middle + side * 0.22;
    const modelling::PolygonMesh mesh = curtain(free_edge, out, bottom, top, y);
    room.smooth(cloth, side < 0.0 ? modelling::turned_inside_out(mesh) : mesh, 80.0);
    modelling::PolygonMesh rings;
    for (int i = 0; i < 6; ++i) {
      modelling::append(rings, ring({std::lerp(out, free_edge, (i + 0.5) / 6.0), y, rod - 0.010}));
    }
    room.smooth(brass, rings, 70.0);
  }
  const double start = window.lower.x - kBeside - 0.06;
  const double length = window.upper.x + kBeside + 0.06 - start;
  PlacedPiece(builder, standing_at({start, y, rod}) * modelling::rotation(1, 90.0))
      .smooth(brass, curtain_rod(length));
}

}  // namespace beambench::scenes::generators

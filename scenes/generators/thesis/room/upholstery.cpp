#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scenes/base/portable_math.hpp"
#include "scenes/generators/thesis/room/room.hpp"
#include "scenes/modelling/lathe.hpp"
#include "scenes/modelling/parametric_surface.hpp"
#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/modelling/subdivide.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kBottom = 0.11;
constexpr double kArm = 0.125;  // half an arm's width

/// Returns the field of a box with round edges.
double rounded_box_field(const glm::dvec3& off, const glm::dvec3& half, double radius) {
  const glm::dvec3 q = glm::abs(off) - (half - radius);
  return glm::length(glm::max(q, 0.0)) + std::min(std::max({q.x, q.y, q.z}), 0.0) - radius;
}

/// Returns the field of a cushion: a rounded box, thicker in its middle along `axis`.
double cushion_field(const glm::dvec3& off, const glm::dvec3& half, int axis) {
  constexpr double kBulge = 0.035;
  glm::dvec3 share = off / half;
  share[axis] = 0.0;
  const double edge = std::min(1.0, glm::dot(share, share));
  return rounded_box_field(off, half, 0.07) - kBulge * (1.0 - edge);
}

double arms_field(const glm::dvec3& p, double width) {
  const glm::dvec3 side(std::abs(p.x) - 0.5 * width + kArm, p.y, p.z);
  const double panel = rounded_box_field(side - glm::dvec3(0.0, 0.0, kBottom + 0.22),
                                         {kArm - 0.02, 0.44, 0.22}, 0.03);
  const double roll =
      modelling::limb_field(side, {{0.0, -0.36, 0.54}, kArm, {0.0, 0.34, 0.54}, kArm - 0.01});
  return modelling::joined(panel, roll, 0.03);
}

double cushions_field(const glm::dvec3& p, const Settee& settee) {
  const double inner = settee.width - 4.0 * kArm + 0.06;
  const double width = inner / settee.places;
  const double place = std::clamp(std::floor((p.x + 0.5 * inner) / width), 0.0,
                                  static_cast<double>(settee.places - 1));
  const double x = p.x + 0.5 * inner - width * (place + 0.5);
  const double seat = cushion_field({x, p.y + 0.09, p.z - 0.41}, {0.5 * width, 0.40, 0.085}, 2);
  // The back cushions lean.
  const double y = p.y - 0.20 - 0.16 * (p.z - 0.68);
  const double back = cushion_field({x, y, p.z - 0.67}, {0.5 * width, 0.10, 0.22}, 1);
  return std::min(seat, back);
}

constexpr double kPile = 0.012;  // the rug's thickness
constexpr int kKnotsX = 46;
constexpr int kKnotsY = 32;

enum Yarn : std::size_t { kRed, kNavy, kCream, kGold, kYarns };
constexpr std::array<glm::vec3, kYarns> kYarnColors = {
    {{0.62F, 0.16F, 0.14F}, {0.14F, 0.20F, 0.38F}, {0.90F, 0.83F, 0.68F}, {0.80F, 0.58F, 0.24F}}};

/// Returns the yarn of a knot. The pattern has borders around a red ground with a stepped
/// medallion.
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

/// Returns one curtain: u from its free edge to the window's side, v upward.
modelling::PolygonMesh curtain(double free_edge, double side, double bottom, double top, double y) {
  constexpr double kTied = 0.34;  // share of its height at which it is drawn aside
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

/// Returns a curtain ring around the rod (x is the rod's axis).
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

double settee_field(const glm::dvec3& p, const Settee& settee) {
  const double inner = 0.5 * settee.width - kArm;
  const double base =
      rounded_box_field(p - glm::dvec3(0.0, 0.0, kBottom + 0.11), {inner, 0.42, 0.11}, 0.03);
  const double back = rounded_box_field({p.x, p.y - 0.33 - 0.10 * (p.z - 0.5), p.z - 0.47},
                                        {inner + 0.06, 0.10, 0.36}, 0.07);
  // The body under and behind the cushions fills the hollow space.
  const double core = rounded_box_field(p - glm::dvec3(0.0, 0.02, 0.33), {inner, 0.36, 0.10}, 0.02);
  const double behind = rounded_box_field({p.x, p.y - 0.26 - 0.13 * (p.z - 0.5), p.z - 0.55},
                                          {inner, 0.06, 0.24}, 0.02);
  double d = modelling::joined(std::min(base, std::min(core, behind)), back, 0.02);
  d = modelling::joined(d, arms_field(p, settee.width), 0.015);
  return modelling::joined(d, cushions_field(p, settee), 0.012);
}

modelling::PolygonMesh settee(const Settee& settee, double cell) {
  const glm::dvec3 lower(-0.5 * settee.width - 0.1, -0.62, 0.0);
  const glm::dvec3 upper(0.5 * settee.width + 0.1, 0.62, 1.05);
  const modelling::PolygonMesh mesh = modelling::implicit_surface(
      [&](const glm::dvec3& place) { return settee_field(place, settee); }, lower, upper, cell);
  return above(modelling::triangulated(mesh), kBottom + 0.012);
}

modelling::PolygonMesh settee_feet(const Settee& settee) {
  modelling::Profile foot({0.022, 0.0});
  foot.line({0.028, 0.02}).curve({0.030, 0.07}, 0.012, 3).line({0.036, kBottom + 0.004});
  modelling::PolygonMesh feet;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-0.36, 0.32}) {
      modelling::append(
          feet, modelling::transformed(modelling::lathe(foot.points(), 10),
                                       standing_at({x * (0.5 * settee.width - 0.12), y, 0.0})));
    }
  }
  return feet;
}

modelling::PolygonMesh scatter_cushion(double half, double height, int steps) {
  // Two sheets over a square whose sides curve inward between the corners.
  const auto sheet = [&](double side) {
    return modelling::parametric_surface(
        [=](double u, double v) {
          const double s = 2.0 * u - 1.0;
          const double t = 2.0 * v - 1.0;
          const double thickness = (1.0 - s * s) * (1.0 - t * t);
          return glm::dvec3(half * s * (1.0 - 0.10 * (1.0 - t * t)),
                            side * half * t * (1.0 - 0.10 * (1.0 - s * s)),
                            side * height * std::sqrt(thickness) * (1.0 - 0.35 * thickness));
        },
        steps, steps);
  };
  modelling::PolygonMesh mesh = modelling::triangulated(sheet(1.0));
  // The sheets touch at the tips of the corners.
  modelling::PolygonMesh lower = modelling::triangulated(sheet(-1.0));
  std::erase_if(lower.polygons, [&](const modelling::PolygonMesh::Corners& corners) {
    return std::all_of(corners.begin(), corners.end(),
                       [&](std::uint32_t corner) { return lower.vertices[corner].z > -1e-9; });
  });
  modelling::append(mesh, lower);
  return mesh;
}

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
  constexpr double kBeside = 0.26;  // width of wall that is also covered on each side
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

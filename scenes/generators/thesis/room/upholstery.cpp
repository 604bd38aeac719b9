#include "scenes/generators/thesis/room/upholstery.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scenes/core/portable_math.hpp"
#include "scenes/generators/thesis/room/placed_piece.hpp"
#include "scenes/modelling/lathe.hpp"
#include "scenes/modelling/parametric_surface.hpp"
#include "scenes/modelling/profile.hpp"
#include "scenes/modelling/subdivide.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kBottom = 0.11;
constexpr double kArm = 0.125;  // half an arm's width

/// A box with round edges.
double rounded_box_field(const glm::dvec3& off, const glm::dvec3& half, double radius) {
  const glm::dvec3 q = glm::abs(off) - (half - radius);
  return glm::length(glm::max(q, 0.0)) + std::min(std::max({q.x, q.y, q.z}), 0.0) - radius;
}

/// A cushion: a rounded box, thicker in its middle along `axis`.
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
  // The back ones lean.
  const double y = p.y - 0.20 - 0.16 * (p.z - 0.68);
  const double back = cushion_field({x, y, p.z - 0.67}, {0.5 * width, 0.10, 0.22}, 1);
  return std::min(seat, back);
}

}  // namespace

double settee_field(const glm::dvec3& p, const Settee& settee) {
  const double inner = 0.5 * settee.width - kArm;
  const double base =
      rounded_box_field(p - glm::dvec3(0.0, 0.0, kBottom + 0.11), {inner, 0.42, 0.11}, 0.03);
  const double back = rounded_box_field({p.x, p.y - 0.33 - 0.10 * (p.z - 0.5), p.z - 0.47},
                                        {inner + 0.06, 0.10, 0.36}, 0.07);
  // What the cushions lie on and lean against, so that nothing is hollow.
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
  // Two sheets over a square whose sides are drawn in between the corners.
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

}  // namespace beambench::scenes::generators

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "scenes/catalogue.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/implicit_surface.hpp"
#include "scenes/modelling/letters.hpp"
#include "scenes/modelling/parametric_surface.hpp"
#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/modelling/subdivide.hpp"
#include "scenes/modelling/sweep.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kCell = 0.0495;

constexpr glm::dvec3 kEye = {0.185, -0.335, 1.60};
constexpr glm::dvec3 kEyeSize = {0.185, 0.16, 0.245};
constexpr glm::dvec3 kBelly = {0.0, -0.20, 0.56};
constexpr glm::dvec3 kMouth = {0.0, -0.56, 1.135};

const std::array<glm::dvec3, 7> kTail = {{{0.15, 0.25, 0.12},
                                          {0.50, 0.42, 0.12},
                                          {0.86, 0.40, 0.22},
                                          {1.04, 0.32, 0.52},
                                          {0.96, 0.26, 0.84},
                                          {1.06, 0.20, 1.12},
                                          {1.26, 0.16, 1.26}}};

/// Mirrors a point to the cat's left half: everything except arms and tail is symmetric.
glm::dvec3 folded(const glm::dvec3& place) { return {std::abs(place.x), place.y, place.z}; }

double head(const glm::dvec3& place) {
  const glm::dvec3 p = folded(place);
  double d = modelling::ellipsoid_field(p, {0.0, 0.0, 1.46}, {0.56, 0.44, 0.44});
  d = modelling::joined(d, modelling::ellipsoid_field(p, {0.33, -0.12, 1.27}, {0.32, 0.28, 0.24}),
                        0.15);
  d = modelling::joined(
      d, modelling::limb_field(p, {{0.34, 0.02, 1.72}, 0.20, {0.50, 0.02, 2.16}, 0.025}), 0.08);
  d = modelling::joined(d, modelling::ellipsoid_field(p, {0.15, -0.43, 1.27}, {0.20, 0.17, 0.15}),
                        0.05);
  d = modelling::joined(d, modelling::ellipsoid_field(p, {0.0, -0.33, 1.13}, {0.25, 0.20, 0.17}),
                        0.06);
  // The open mouth is dug out of the chin.
  return std::max(d, -modelling::ellipsoid_field(p, kMouth, {0.16, 0.16, 0.10}));
}

double tail(const glm::dvec3& place) {
  double d = 1e9;
  for (std::size_t i = 0; i + 1 < kTail.size(); ++i) {
    d = modelling::joined(d, modelling::limb_field(place, {kTail[i], 0.095, kTail[i + 1], 0.095}),
                          0.04);
  }
  return d;
}

/// Returns the field of the arms: one waves, the other reaches down to the knee.
double arms(const glm::dvec3& place) {
  double d = modelling::limb_field(place, {{-0.30, 0.0, 0.84}, 0.12, {-0.80, -0.12, 0.98}, 0.10});
  d = modelling::joined(
      d, modelling::limb_field(place, {{-0.80, -0.12, 0.98}, 0.10, {-0.98, -0.20, 1.28}, 0.10}),
      0.05);
  d = modelling::joined(
      d, modelling::limb_field(place, {{0.32, -0.02, 0.84}, 0.12, {0.56, -0.20, 0.60}, 0.10}),
      0.05);
  return modelling::joined(
      d, modelling::limb_field(place, {{0.56, -0.20, 0.60}, 0.10, {0.50, -0.48, 0.46}, 0.10}),
      0.05);
}

/// Returns the field of the white gloves, each with a thumb and three fingers.
double gloves(const glm::dvec3& place) {
  constexpr double kFinger = 0.062;
  double d = modelling::ellipsoid_field(place, {-1.00, -0.22, 1.40}, {0.15, 0.12, 0.15});
  d = modelling::joined(
      d, modelling::limb_field(place, {{-0.98, -0.22, 1.40}, 0.07, {-0.78, -0.28, 1.44}, kFinger}),
      0.03);
  d = modelling::joined(
      d, modelling::limb_field(place, {{-0.96, -0.22, 1.45}, 0.07, {-0.91, -0.23, 1.67}, kFinger}),
      0.03);
  d = modelling::joined(
      d, modelling::limb_field(place, {{-1.02, -0.22, 1.45}, 0.07, {-1.07, -0.23, 1.69}, kFinger}),
      0.03);
  d = modelling::joined(
      d, modelling::limb_field(place, {{-1.07, -0.22, 1.42}, 0.07, {-1.22, -0.23, 1.60}, kFinger}),
      0.03);
  const glm::dvec3 knee(0.49, -0.56, 0.45);
  d = std::min(d, modelling::ellipsoid_field(place, knee, {0.15, 0.14, 0.12}));
  for (const double x : {-0.10, 0.01, 0.11}) {
    const glm::dvec3 tip = knee + glm::dvec3(x, -0.15, -0.06);
    d = modelling::joined(d, modelling::limb_field(place, {knee, 0.07, tip, kFinger}), 0.03);
  }
  return d;
}

double feet(const glm::dvec3& place) {
  const glm::dvec3 p = folded(place);
  double d = modelling::ellipsoid_field(p, {0.47, -0.74, 0.20}, {0.20, 0.19, 0.22});
  for (const double x : {0.35, 0.47, 0.59}) {
    d = modelling::joined(d, modelling::ellipsoid_field(p, {x, -0.86, 0.27}, {0.075, 0.09, 0.13}),
                          0.03);
  }
  return d;
}

double fur(const glm::dvec3& place) {
  const glm::dvec3 p = folded(place);
  double d = modelling::ellipsoid_field(p, {0.0, 0.0, 0.44}, {0.46, 0.42, 0.46});
  d = modelling::joined(
      d, modelling::limb_field(p, {{0.0, 0.0, 0.60}, 0.36, {0.0, 0.0, 0.98}, 0.26}), 0.20);
  d = modelling::joined(
      d, modelling::limb_field(p, {{0.28, -0.10, 0.22}, 0.21, {0.46, -0.66, 0.19}, 0.14}), 0.08);
  d = modelling::joined(d, arms(place), 0.08);
  d = modelling::joined(d, tail(place), 0.06);
  return modelling::joined(d, head(place), 0.05);
}

double cat(const glm::dvec3& place) {
  const double d =
      modelling::joined(modelling::joined(fur(place), gloves(place), 0.02), feet(place), 0.03);
  return std::max(d, -place.z);  // the cat sits on the floor
}

constexpr double kSquint = 16.0;  // degrees that each eye turns toward the nose

constexpr glm::dvec3 kNose = {0.0, -0.59, 1.37};
constexpr glm::dvec3 kNoseSize = {0.085, 0.06, 0.058};
constexpr glm::dvec3 kTongue = {0.0, -0.47, 1.07};
constexpr glm::dvec3 kTongueSize = {0.10, 0.17, 0.035};

/// Returns the rotation of an eye that looks straight ahead to the direction of the cat's left eye
/// (side 1) or right eye.
glm::dmat4 eye_turn(double side) {
  const glm::dvec3 center = kEye * glm::dvec3(side, 1.0, 1.0);
  return glm::translate(glm::dmat4(1.0), center) * modelling::rotation(2, -kSquint * side) *
         glm::translate(glm::dmat4(1.0), -center);
}

/// Returns the field of eyes, nose and tongue, which hide the fur behind them.
double features(const glm::dvec3& place) {
  const glm::dvec3 straight(glm::inverse(eye_turn(1.0)) * glm::dvec4(folded(place), 1.0));
  return std::min({modelling::ellipsoid_field(straight, kEye, kEyeSize),
                   modelling::ellipsoid_field(place, kNose, kNoseSize),
                   modelling::ellipsoid_field(place, kTongue, kTongueSize)});
}

enum Color : int { kOrange, kStripe, kCream, kWhite, kPink, kDark };

bool is_stripe(const glm::dvec3& place, const glm::dvec3& p) {
  if (tail(place) < 0.03) {
    const double along = p.x + 0.9 * p.z;
    return p.x > 0.45 && std::fmod(along, 0.36) < 0.14;
  }
  if (p.z > 1.80 && place.y < 0.3) {  // three stripes on the forehead
    return p.x < 0.028 || (p.x > 0.09 && p.x < 0.145 && p.z > 1.84);
  }
  const bool on_cheek = p.z > 1.16 && p.z < 1.5 && p.x > 0.50 && place.y > -0.34;
  if (on_cheek) return std::abs(p.z - 1.26) < 0.026 || std::abs(p.z - 1.38) < 0.026;
  const bool on_back = p.z > 0.2 && p.z < 1.0 && place.y > 0.02;
  return on_back && arms(place) > 0.05 && std::fmod(p.z, 0.2) < 0.07;
}

int region(const glm::dvec3& place) {
  const glm::dvec3 p = folded(place);
  if (modelling::ellipsoid_field(p, kMouth, {0.17, 0.17, 0.11}) < 0.0) return kDark;
  if (gloves(place) < fur(place) || feet(place) < fur(place)) return kWhite;
  const double snout = modelling::ellipsoid_field(p, {0.15, -0.45, 1.27}, {0.23, 0.20, 0.17});
  const double chin = modelling::ellipsoid_field(p, {0.0, -0.40, 1.12}, {0.23, 0.20, 0.15});
  if (std::min(snout, chin) < 0.0) return kCream;
  if (modelling::ellipsoid_field(p, kBelly, {0.30, 0.40, 0.36}) < 0.0 && p.y < -0.2) return kCream;
  const double ear =
      modelling::limb_field(p, {{0.37, -0.12, 1.80}, 0.11, {0.475, -0.06, 2.06}, 0.03});
  if (ear < 0.0) return kPink;
  return is_stripe(place, p) ? kStripe : kOrange;
}

Surface surface_of(int color) {
  switch (color) {
    case kStripe:
      return {.color = {0.62F, 0.26F, 0.06F}, .diffuse = 0.9F};
    case kCream:
      return {.color = {1.0F, 0.87F, 0.66F}, .diffuse = 0.9F};
    case kWhite:
      return {.color = {0.97F, 0.97F, 0.95F}, .diffuse = 0.9F};
    case kPink:
      return {.color = {0.95F, 0.55F, 0.55F}, .diffuse = 0.9F};
    case kDark:
      return {.color = {0.35F, 0.05F, 0.07F}, .diffuse = 0.8F};
    default:
      return {.color = {0.96F, 0.52F, 0.13F}, .diffuse = 0.9F};
  }
}

void add_fur(SceneBuilder& builder) {
  const modelling::PolygonMesh rough =
      modelling::implicit_surface(cat, {-1.45, -1.12, -0.05}, {1.55, 0.65, 2.3}, kCell);
  modelling::PolygonMesh mesh =
      modelling::drawn_to_borders(modelling::triangulated(rough), cat, region);
  mesh = modelling::outside(mesh, features);
  // The floor hides the underside.
  std::erase_if(mesh.polygons, [&](const modelling::PolygonMesh::Corners& corners) {
    return std::all_of(corners.begin(), corners.end(),
                       [&](std::uint32_t corner) { return mesh.vertices[corner].z < 1e-3; });
  });
  modelling::add_smooth(builder, mesh,
                        {.crease = 70.0, .paint = [&](std::size_t polygon) {
                           return surface_of(region(modelling::middle(mesh, polygon)));
                         }});
}

/// Returns an ellipsoid with its poles on y.
modelling::PolygonMesh ball(const glm::dvec3& center, const glm::dvec3& half_axes, int slices,
                            int stacks) {
  modelling::PolygonMesh mesh =
      modelling::ellipsoid({half_axes.x, half_axes.z, half_axes.y}, slices, stacks);
  for (glm::dvec3& vertex : mesh.vertices) {
    vertex = center + glm::dvec3(vertex.x, -vertex.z, vertex.y);
  }
  return mesh;
}

void add_eyes(SceneBuilder& builder) {
  const Surface white = {
      .color = glm::vec3(1.0F), .diffuse = 0.9F, .specular = 0.5F, .shine = 60.0F};
  const Surface black = {
      .color = glm::vec3(0.04F), .diffuse = 0.7F, .specular = 0.7F, .shine = 60.0F};
  for (const double side : {-1.0, 1.0}) {
    const glm::dvec3 center = kEye * glm::dvec3(side, 1.0, 1.0);
    modelling::PolygonMesh mesh = ball(center, kEyeSize, 24, 20);
    const double rim = center.y - 0.86 * kEyeSize.y;
    std::vector<bool> is_pupil;
    mesh = modelling::outside(modelling::transformed(std::move(mesh), eye_turn(side)), head);
    const glm::dmat4 straight = glm::inverse(eye_turn(side));
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      is_pupil.push_back((straight * glm::dvec4(modelling::middle(mesh, i), 1.0)).y < rim);
    }
    modelling::add_smooth(builder, mesh, {.paint = [&](std::size_t polygon) {
                            return is_pupil[polygon] ? black : white;
                          }});
  }
}

void add_whiskers(SceneBuilder& builder) {
  builder.set_surface({.color = glm::vec3(0.15F), .diffuse = 0.8F});
  for (const double side : {-1.0, 1.0}) {
    for (const double rise : {-0.10, 0.0, 0.10}) {
      const std::vector<glm::dvec3> knots = {{0.27 * side, -0.52, 1.27 + 0.4 * rise},
                                             {0.55 * side, -0.60, 1.30 + 1.2 * rise},
                                             {0.86 * side, -0.56, 1.26 + 2.4 * rise}};
      const std::vector<glm::dvec3> path = modelling::spline(knots, 4);
      std::vector<double> radii;
      for (std::size_t i = 0; i < path.size(); ++i) {
        radii.push_back(0.011 * static_cast<double>(path.size() - 1 - i) /
                        static_cast<double>(path.size() - 1));
      }
      modelling::add_smooth(builder, modelling::outside(modelling::tube(path, radii, 5), head));
    }
  }
}

/// Adds a sitting cartoon cat, 2.2 high, facing -y, with its seat and feet on z = 0. It consists of
/// the fur, then eyes, nose, tongue and whiskers, each without the polygons inside the head.
void add_cartoon_cat(SceneBuilder& builder) {
  add_fur(builder);
  add_eyes(builder);
  builder.set_surface(
      {.color = {0.92F, 0.38F, 0.42F}, .diffuse = 0.8F, .specular = 0.4F, .shine = 30.0F});
  modelling::add_smooth(builder, modelling::outside(ball(kNose, kNoseSize, 16, 10), head));
  builder.set_surface({.color = {0.93F, 0.25F, 0.30F}, .diffuse = 0.85F});
  modelling::add_smooth(builder, modelling::outside(ball(kTongue, kTongueSize, 16, 12), head));
  add_whiskers(builder);
}

constexpr std::size_t kPolygons = 15128;

/// Returns the name, floating behind the cat's ears.
modelling::PolygonMesh name() {
  constexpr double kHeight = 0.76;
  glm::dmat4 place = glm::translate(
      glm::dmat4(1.0), glm::dvec3(-0.5 * modelling::text_width("GATO BILL", kHeight), 1.6, 2.2));
  place[1] = glm::dvec4(0.0, 0.0, 1.0, 0.0);   // letters stand
  place[2] = glm::dvec4(0.0, -1.0, 0.0, 0.0);  // and face the reader
  return modelling::transformed(modelling::extruded_text("GATO BILL", kHeight, 0.3), place);
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  Camera camera;
  camera.from = {-0.4F, -7.0F, 2.9F};
  camera.at = {0.0F, 0.0F, 1.22F};
  camera.up = {0.0F, 0.0F, 1.0F};
  camera.angle = 36.0F;
  builder.add_camera(camera);
  builder.set_background({0.55, 0.78, 0.95});
  builder.add_light({-4.0, -7.0, 8.0}, glm::dvec3(0.85));
  builder.add_light({5.0, -5.0, 4.0}, glm::dvec3(0.35));

  builder.set_surface({.color = {0.42F, 0.70F, 0.40F}, .diffuse = 0.9F});
  const std::array<glm::dvec3, 4> floor = {
      {{-6.0, -4.5, 0.0}, {6.0, -4.5, 0.0}, {6.0, 4.5, 0.0}, {-6.0, 4.5, 0.0}}};
  builder.add_polygon(floor);
  add_cartoon_cat(builder);
  builder.set_surface(
      {.color = {0.80F, 0.16F, 0.22F}, .diffuse = 0.8F, .specular = 0.3F, .shine = 20.0F});
  modelling::add_flat(builder, modelling::subdivided_to(modelling::triangulated(name()),
                                                        kPolygons - builder.primitive_count()));
  return std::move(builder).build();
}

}  // namespace

void register_gato_bill(Catalogue& catalogue) {
  catalogue.add(
      {"gato-bill",
       "The thesis's Gato-Bill: a cartoon cat on one large floor polygon before its name in "
       "letters",
       {},
       generate});
}

}  // namespace beambench::scenes::generators

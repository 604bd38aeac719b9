#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "scenes/base/portable_math.hpp"
#include "scenes/base/random.hpp"
#include "scenes/generators/thesis/plant.hpp"
#include "scenes/generators/thesis/room/room.hpp"
#include "scenes/modelling/box.hpp"
#include "scenes/modelling/lathe.hpp"
#include "scenes/modelling/parametric_surface.hpp"
#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/modelling/subdivide.hpp"
#include "scenes/modelling/sweep.hpp"
#include "scenes/modelling/walls.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kFrame = 0.055;
constexpr double kCanvas = 0.010;  // distance from the wall

Surface paint(const glm::vec3& color) { return {.color = color, .diffuse = 0.95F}; }

/// Adds the frame, and the canvas inside it.
void add_frame(PlacedPiece& picture, const glm::dvec2& size, const glm::vec3& ground) {
  const std::vector<glm::dvec2> profile = {{0.0, 0.0},     {0.0, 0.022},     {0.010, 0.032},
                                           {0.022, 0.030}, {0.036, 0.018},   {0.044, 0.022},
                                           {0.050, 0.020}, {kFrame, kCanvas}};
  picture.flat({.color = {0.72F, 0.53F, 0.22F}, .diffuse = 0.85F, .specular = 0.5F, .shine = 40.0F},
               modelling::molding(size, profile));
  modelling::PolygonMesh canvas = modelling::box({kFrame, kFrame, 0.0}, {size - kFrame, kCanvas});
  canvas.polygons = {canvas.polygons[5]};
  picture.flat(paint(ground), canvas);
}

/// Returns a flat polygon slightly in front of the canvas.
modelling::PolygonMesh patch(const std::vector<glm::dvec2>& outline, int layer) {
  modelling::PolygonMesh mesh;
  modelling::PolygonMesh::Corners corners;
  for (const glm::dvec2& point : outline) {
    corners.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    mesh.vertices.emplace_back(point, kCanvas + 0.0015 * layer);
  }
  mesh.polygons = {corners};
  return mesh;
}

void sierpinski(const std::array<glm::dvec2, 3>& corners, int depth, modelling::PolygonMesh& mesh) {
  if (depth == 0) {
    modelling::append(mesh, patch({corners[0], corners[1], corners[2]}, 1));
    return;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<glm::dvec2, 3> part;
    for (std::size_t k = 0; k < 3; ++k) part[k] = 0.5 * (corners[i] + corners[k]);
    sierpinski(part, depth - 1, mesh);
  }
}

/// Returns a clock's hand from its axis to an hour of the dial.
modelling::PolygonMesh hand(double hour, double length, double width) {
  modelling::PolygonMesh mesh =
      modelling::box({-0.5 * width, -0.2 * length, 0.0}, {0.5 * width, length, 0.004});
  mesh.polygons.erase(mesh.polygons.begin() + 4);  // the back is never visible
  return modelling::transformed(mesh, modelling::rotation(2, -30.0 * hour));
}

const Surface kBrass = {
    .color = {0.80F, 0.63F, 0.28F}, .diffuse = 0.8F, .specular = 0.7F, .shine = 50.0F};
const Surface kEnamel = {
    .color = {0.20F, 0.45F, 0.42F}, .diffuse = 0.85F, .specular = 0.5F, .shine = 50.0F};
const Surface kInside = {.color = {0.98F, 0.95F, 0.86F}, .diffuse = 1.0F};
const Surface kBulb = {.color = {1.0F, 0.98F, 0.88F}, .diffuse = 1.0F};

modelling::PolygonMesh bulb(double z) {
  modelling::PolygonMesh mesh = modelling::ellipsoid({0.045, 0.045, 0.058}, 14, 9);
  for (glm::dvec3& vertex : mesh.vertices) vertex.z += z;
  return mesh;
}

/// Returns a lampshade of paper, open above and below, folded into pleats.
modelling::PolygonMesh pleated_shade(double low, double low_radius, double high,
                                     double high_radius) {
  constexpr int kPleats = 32;
  modelling::Profile profile({low_radius, low});
  profile.curve({high_radius, high}, -0.012, 4);
  modelling::PolygonMesh mesh = modelling::lathe(profile.points(), 2 * kPleats);
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 2) {
    mesh.vertices[i].x *= 1.035;
    mesh.vertices[i].y *= 1.035;
  }
  return mesh;
}

}  // namespace

void add_triangle_picture(SceneBuilder& builder, const glm::dmat4& place) {
  const glm::dvec2 size(0.62, 0.62);
  PlacedPiece picture(builder, place);
  add_frame(picture, size, {0.93F, 0.91F, 0.84F});
  modelling::PolygonMesh triangles;
  sierpinski({{{0.10, 0.12}, {0.52, 0.12}, {0.31, 0.50}}}, 4, triangles);
  picture.flat(paint({0.78F, 0.16F, 0.14F}), triangles);
}

void add_boat_picture(SceneBuilder& builder, const glm::dmat4& place) {
  const glm::dvec2 size(0.80, 0.60);
  PlacedPiece picture(builder, place);
  add_frame(picture, size, {0.74F, 0.87F, 0.95F});
  std::vector<glm::dvec2> sun;
  for (const glm::dvec2& point : modelling::circle(20))
    sun.push_back(glm::dvec2(0.60, 0.42) + 0.055 * point);
  picture.flat(paint({0.98F, 0.83F, 0.35F}), patch(sun, 1));
  for (int wave = 0; wave < 3; ++wave) {
    std::vector<glm::dvec2> outline = {{kFrame, kFrame}, {size.x - kFrame, kFrame}};
    for (int i = 24; i >= 0; --i) {
      const double x = std::lerp(kFrame, size.x - kFrame, i / 24.0);
      outline.emplace_back(x, 0.25 - 0.055 * wave + 0.012 * portable_sin(22.0 * x + 2.0 * wave));
    }
    const glm::vec3 blue = glm::vec3(0.26F, 0.50F, 0.70F) - 0.07F * static_cast<float>(wave);
    picture.flat(paint(blue), patch(outline, 1 + 2 * wave));
  }
  picture.flat(paint({0.50F, 0.24F, 0.14F}),
               patch({{0.25, 0.21}, {0.45, 0.21}, {0.49, 0.26}, {0.21, 0.26}}, 2));
  picture.flat(paint({0.98F, 0.96F, 0.90F}),
               patch({{0.36, 0.275}, {0.48, 0.275}, {0.36, 0.50}}, 2));
  picture.flat(paint({0.84F, 0.30F, 0.22F}),
               patch({{0.345, 0.275}, {0.345, 0.46}, {0.24, 0.275}}, 2));
}

void add_clock(SceneBuilder& builder, const glm::dmat4& place) {
  PlacedPiece clock(builder, place);
  modelling::Profile rim({0.17, 0.0});
  rim.line({0.17, 0.020}).curve({0.145, 0.028}, 0.012, 5).line({0.142, 0.012});
  clock.smooth({.color = {0.38F, 0.22F, 0.12F}, .diffuse = 0.85F, .specular = 0.4F, .shine = 40.0F},
               modelling::lathe(rim.points(), 36));
  const std::vector<glm::dvec2> dial = {{0.142, 0.012}, {0.0, 0.012}};
  clock.flat(paint({0.97F, 0.96F, 0.92F}), modelling::lathe(dial, 36));
  modelling::PolygonMesh marks;
  for (int hour = 0; hour < 12; ++hour) {
    const double half = hour % 3 == 0 ? 0.006 : 0.003;
    modelling::PolygonMesh mark;
    mark.vertices = {{-half, 0.108, 0.0135},
                     {half, 0.108, 0.0135},
                     {half, 0.132, 0.0135},
                     {-half, 0.132, 0.0135}};
    mark.polygons = {{0, 1, 2, 3}};
    modelling::append(marks, modelling::transformed(mark, modelling::rotation(2, -30.0 * hour)));
  }
  clock.flat(paint({0.12F, 0.11F, 0.11F}), marks);
  const glm::dmat4 hour_level = glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, 0.014));
  const glm::dmat4 minute_level = glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, 0.019));
  modelling::PolygonMesh hands =
      modelling::transformed(hand(10.0 + 1.0 / 6.0, 0.075, 0.012), hour_level);
  modelling::append(hands, modelling::transformed(hand(2.0, 0.110, 0.008), minute_level));
  clock.flat(paint({0.12F, 0.11F, 0.11F}), hands);
}

void add_potted_plant(SceneBuilder& builder, const glm::dvec3& place) {
  constexpr double kSoil = 0.285;
  constexpr int kLeaves = 28;
  PlacedPiece plant(builder, standing_at(place));
  modelling::Profile pot({0.125, 0.0});
  pot.line({0.165, 0.25}).line({0.182, 0.25}).curve({0.182, 0.32}, 0.006, 3).line({0.165, 0.32});
  pot.line({0.160, kSoil});
  plant.smooth({.color = {0.76F, 0.38F, 0.22F}, .diffuse = 0.9F},
               modelling::lathe(pot.points(), 24));
  const std::vector<glm::dvec2> soil = {
      {0.160, kSoil}, {0.06, kSoil + 0.015}, {0.0, kSoil + 0.018}};
  plant.smooth({.color = {0.25F, 0.16F, 0.10F}, .diffuse = 0.9F}, modelling::lathe(soil, 24));

  // Leaves are a golden angle apart, and the outer leaves droop (as in maceta); no leaf intersects
  // a wall.
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  Random random(5);
  modelling::PolygonMesh leaves;
  for (int i = 0; i < kLeaves; ++i) {
    const double s = (i + 0.5) / kLeaves;
    ArchingLeaf leaf;
    leaf.azimuth = golden * i + random.uniform(-0.15, 0.15);
    leaf.root = glm::dvec3(0.05 * (1.0 - s) * portable_cos(leaf.azimuth),
                           0.05 * (1.0 - s) * portable_sin(leaf.azimuth), kSoil + 0.012);
    leaf.rise = std::lerp(1.10, 1.52, s) + random.uniform(-0.05, 0.05);
    leaf.fall = std::lerp(0.95, 0.15, s) + random.uniform(-0.2, 0.2);
    leaf.length = std::lerp(0.50, 0.82, s) * random.uniform(0.9, 1.05);
    leaf.width = 0.075 * random.uniform(0.85, 1.15);
    modelling::append(leaves, arching_leaf(leaf, 11));
  }
  plant.smooth({.color = {0.22F, 0.50F, 0.20F}, .diffuse = 0.85F, .specular = 0.2F, .shine = 12.0F},
               leaves);
}

void add_hanging_lamp(SceneBuilder& builder, const glm::dvec3& rim, double ceiling) {
  PlacedPiece lamp(builder, standing_at(rim));
  modelling::Profile shade({0.235, 0.0});
  shade.line({0.240, 0.006}).curve({0.10, 0.135}, 0.028, 7).line({0.045, 0.15}).line({0.04, 0.20});
  lamp.smooth(kEnamel, modelling::lathe(shade.points(), 32));
  modelling::Profile inside({0.035, 0.138});
  inside.line({0.095, 0.127}).curve({0.235, 0.0}, -0.026, 7);
  lamp.smooth(kInside, modelling::lathe(inside.points(), 32));
  lamp.smooth(kBulb, bulb(0.068));

  const double height = ceiling - rim.z;
  modelling::Profile cord({0.04, 0.20});
  cord.curve({0.006, 0.235}, 0.006, 5).line({0.006, height - 0.05});
  cord.curve({0.055, height - 0.004}, -0.012, 5).line({0.055, height});
  lamp.smooth(kBrass, modelling::lathe(cord.points(), 14));
}

void add_floor_lamp(SceneBuilder& builder, const glm::dvec3& place) {
  PlacedPiece lamp(builder, standing_at(place));
  modelling::Profile stand({0.15, 0.0});
  stand.line({0.15, 0.012})
      .curve({0.03, 0.045}, -0.006, 5)
      .curve({0.014, 0.08}, 0.008, 4)
      .line({0.012, 0.62})
      .curve({0.012, 0.70}, 0.020, 5)
      .line({0.012, 1.24})
      .curve({0.012, 1.30}, 0.016, 5)
      .line({0.010, 1.40});
  lamp.smooth(kBrass, modelling::lathe(stand.points(), 16));
  lamp.smooth(kBulb, bulb(1.445));
  lamp.flat({.color = {0.98F, 0.90F, 0.68F}, .diffuse = 1.0F},
            pleated_shade(1.32, 0.235, 1.66, 0.135));
}

}  // namespace beambench::scenes::generators

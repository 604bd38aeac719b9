#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include <glm/gtc/matrix_transform.hpp>

#include "scenes/base/portable_math.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/box.hpp"
#include "scenes/modelling/extrusion.hpp"
#include "scenes/modelling/implicit_surface.hpp"
#include "scenes/modelling/lathe.hpp"
#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/modelling/subdivide.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr int kSides = 18;

/// Returns the foot that all pieces have: a plinth, a torus and a step.
modelling::Profile foot(double radius) {
  modelling::Profile profile({radius, 0.0});
  profile.line({radius, 0.05})
      .curve({radius - 0.05, 0.14}, 0.03, 2)
      .line({radius - 0.09, 0.15})
      .line({radius - 0.10, 0.18});
  return profile;
}

/// Adds the collar under a head: a disc with a round edge around a stem of radius `stem`.
modelling::Profile& collar(modelling::Profile& profile, double stem, double radius, double height) {
  return profile.line({radius - 0.03, height})
      .curve({radius - 0.03, height + 0.05}, 0.03, 2)
      .line({stem, height + 0.07});
}

/// Raises the points of the crown's rim: every second vertex of the ring at `height`.
void raise_points(modelling::PolygonMesh& mesh, double height, double rise) {
  std::size_t nth = 0;
  for (glm::dvec3& vertex : mesh.vertices) {
    if (std::abs(vertex.z - height) > 1e-9) continue;
    if (nth++ % 2 == 0) vertex.z += rise;
  }
}

/// Returns a block of the rook's battlements over some of the lathe's sides: its inside, outside,
/// top and ends.
modelling::PolygonMesh merlon(int first, int count, double inner, double outer, double low,
                              double high) {
  modelling::PolygonMesh mesh;
  for (int i = first; i <= first + count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 24;
    const glm::dvec2 direction(portable_cos(angle), portable_sin(angle));
    for (const double z : {low, high}) {
      for (const double radius : {outer, inner}) mesh.vertices.emplace_back(radius * direction, z);
    }
  }
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
    const std::uint32_t a = 4 * i;  // outer low, inner low, outer high, inner high
    const std::uint32_t b = a + 4;
    mesh.polygons.push_back({a, b, b + 2, a + 2});
    mesh.polygons.push_back({a + 2, b + 2, b + 3, a + 3});
    mesh.polygons.push_back({b + 1, a + 1, a + 3, b + 3});
  }
  const auto end = static_cast<std::uint32_t>(4 * count);
  mesh.polygons.push_back({0, 2, 3, 1});
  mesh.polygons.push_back({end, end + 1, end + 3, end + 2});
  return mesh;
}

/// Returns the field of the horse's head and neck, facing +x.
double horse(const glm::dvec3& place) {
  const glm::dvec3 p(place.x, 1.15 * std::abs(place.y), place.z);
  double d = modelling::limb_field(p, {{0.0, 0.0, 0.22}, 0.25, {-0.09, 0.0, 0.60}, 0.19});
  d = modelling::joined(
      d, modelling::limb_field(p, {{-0.09, 0.0, 0.60}, 0.19, {0.0, 0.0, 0.98}, 0.145}), 0.05);
  d = modelling::joined(
      d, modelling::limb_field(p, {{0.02, 0.0, 0.99}, 0.15, {0.29, 0.0, 0.80}, 0.085}), 0.06);
  d = modelling::joined(d, modelling::ellipsoid_field(p, {0.06, 0.0, 0.88}, {0.15, 0.13, 0.13}),
                        0.05);
  d = modelling::joined(d, modelling::ellipsoid_field(p, {0.31, 0.03, 0.80}, {0.07, 0.075, 0.06}),
                        0.03);
  d = modelling::joined(
      d, modelling::limb_field(p, {{-0.04, 0.07, 1.08}, 0.055, {-0.02, 0.085, 1.26}, 0.022}), 0.03);
  // The eyes, and the mane down the back of the neck.
  d = modelling::joined(d, modelling::ellipsoid_field(p, {0.09, 0.125, 1.02}, {0.04, 0.035, 0.035}),
                        0.01);
  d = modelling::joined(
      d, modelling::limb_field(p, {{-0.08, 0.0, 1.10}, 0.05, {-0.25, 0.0, 0.82}, 0.06}), 0.03);
  d = modelling::joined(
      d, modelling::limb_field(p, {{-0.25, 0.0, 0.82}, 0.06, {-0.28, 0.0, 0.50}, 0.06}), 0.03);
  return d;
}

/// These functions return Staunton's pieces without their undersides, standing at the origin of a
/// board whose squares have side 1. The knight faces +y.
modelling::PolygonMesh chess_pawn() {
  modelling::Profile profile = foot(0.32);
  profile.curve({0.11, 0.58}, -0.07, 5);
  collar(profile, 0.11, 0.20, 0.60).ball(0.81, 0.165, 7);
  return modelling::lathe(profile.points(), kSides);
}

modelling::PolygonMesh chess_rook() {
  modelling::Profile profile = foot(0.36);
  profile.curve({0.19, 0.74}, -0.045, 7).curve({0.29, 0.86}, -0.02, 3).line({0.29, 1.02});
  const std::vector<glm::dvec2> well = {{0.20, 1.02}, {0.20, 0.94}, {0.0, 0.94}};
  modelling::PolygonMesh mesh = modelling::lathe(profile.points(), 24);
  modelling::append(mesh, modelling::lathe(well, 24));
  constexpr int kMerlon = 4;
  constexpr int kGap = 2;
  const std::vector<glm::dvec2> rim = {{0.29, 1.02}, {0.20, 1.02}};
  const modelling::PolygonMesh ring = modelling::lathe(rim, 24);
  for (int first = 0; first < 24; first += kMerlon + kGap) {
    modelling::append(mesh, merlon(first, kMerlon, 0.20, 0.29, 1.02, 1.15));
    modelling::PolygonMesh gap;
    gap.vertices = ring.vertices;
    gap.polygons.assign(ring.polygons.begin() + first + kMerlon,
                        ring.polygons.begin() + first + kMerlon + kGap);
    modelling::append(mesh, gap);
  }
  return mesh;
}

modelling::PolygonMesh chess_knight() {
  constexpr double kTop = 0.24;
  modelling::Profile profile = foot(0.37);
  profile.line({0.27, 0.20}).curve({0.29, kTop}, 0.02, 2).line({0.0, kTop});
  modelling::PolygonMesh base = modelling::lathe(profile.points(), 24);
  modelling::PolygonMesh head = modelling::triangulated(modelling::implicit_surface(
      [&](const glm::dvec3& place) { return std::max(horse(place), kTop - place.z); },
      {-0.45, -0.4, 0.2}, {0.5, 0.4, 1.4}, 0.058));
  std::erase_if(head.polygons,
                [&](const modelling::PolygonMesh::Corners& corners) {  // the base hides this part
                  return std::all_of(corners.begin(), corners.end(), [&](std::uint32_t corner) {
                    return head.vertices[corner].z < kTop + 1e-6;
                  });
                });
  modelling::append(head, base);
  return modelling::transformed(std::move(head), modelling::rotation(2, 90.0));
}

modelling::PolygonMesh chess_bishop() {
  modelling::Profile profile = foot(0.36);
  profile.curve({0.12, 0.80}, -0.08, 8);
  collar(profile, 0.12, 0.24, 0.82);
  collar(profile, 0.10, 0.17, 0.92)
      .curve({0.165, 1.09}, 0.02, 3)
      .curve({0.045, 1.36}, 0.05, 6)
      .ball(1.40, 0.06, 6);
  return modelling::lathe(profile.points(), kSides);
}

modelling::PolygonMesh chess_queen() {
  constexpr double kRim = 1.56;
  modelling::Profile profile = foot(0.39);
  profile.curve({0.13, 1.00}, -0.09, 9);
  collar(profile, 0.13, 0.27, 1.02);
  collar(profile, 0.12, 0.19, 1.12)
      .curve({0.25, kRim}, -0.05, 6)
      .line({0.20, kRim - 0.06})
      .curve({0.05, kRim + 0.04}, 0.03, 4)
      .ball(kRim + 0.09, 0.065, 6);
  modelling::PolygonMesh mesh = modelling::lathe(profile.points(), kSides);
  raise_points(mesh, kRim, 0.07);
  return mesh;
}

modelling::PolygonMesh chess_king() {
  modelling::Profile profile = foot(0.41);
  profile.curve({0.14, 1.12}, -0.09, 9);
  collar(profile, 0.14, 0.29, 1.14);
  collar(profile, 0.13, 0.20, 1.24)
      .curve({0.235, 1.66}, -0.03, 6)
      .line({0.215, 1.70})
      .curve({0.04, 1.78}, 0.03, 4)
      .line({0.0, 1.785});
  modelling::PolygonMesh mesh = modelling::lathe(profile.points(), kSides);
  modelling::PolygonMesh cross = modelling::extruded(modelling::flat_polygon({{-0.03, -0.02},
                                                                              {0.03, -0.02},
                                                                              {0.03, 0.09},
                                                                              {0.10, 0.07},
                                                                              {0.10, 0.17},
                                                                              {0.03, 0.15},
                                                                              {0.05, 0.25},
                                                                              {-0.05, 0.25},
                                                                              {-0.03, 0.15},
                                                                              {-0.10, 0.17},
                                                                              {-0.10, 0.07},
                                                                              {-0.03, 0.09}}),
                                                     0.05);
  cross.polygons.erase(cross.polygons.begin() + 2);  // the side inside the crown
  modelling::append(
      mesh, modelling::transformed(modelling::triangulated(cross),
                                   glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.025, 1.785)) *
                                       modelling::rotation(0, 90.0)));
  return mesh;
}

constexpr std::size_t kPolygons = 19734;

/// The Spanish opening, 1. e4 e5 2. Nf3 Nc6 3. Bb5, seen from White's side: the eighth rank comes
/// first, and White is in capitals.
constexpr std::array<std::string_view, 8> kPosition = {{"r.bqkbnr", "pppp.ppp", "..n.....",
                                                        ".B..p...", "....P...", ".....N..",
                                                        "PPPP.PPP", "RNBQK..R"}};

/// The set's pieces, each modeled once.
class ChessSet {
 public:
  const modelling::PolygonMesh& piece(char name) const {
    switch (name) {
      case 'r':
        return rook_;
      case 'n':
        return knight_;
      case 'b':
        return bishop_;
      case 'q':
        return queen_;
      case 'k':
        return king_;
      default:
        return pawn_;
    }
  }

 private:
  modelling::PolygonMesh pawn_ = chess_pawn();
  modelling::PolygonMesh rook_ = chess_rook();
  modelling::PolygonMesh knight_ = chess_knight();
  modelling::PolygonMesh bishop_ = chess_bishop();
  modelling::PolygonMesh queen_ = chess_queen();
  modelling::PolygonMesh king_ = chess_king();
};

glm::dvec3 middle_of(std::size_t row, std::size_t column) {
  return {static_cast<double>(column) - 3.5, 3.5 - static_cast<double>(row), 0.0};
}

void add_squares(SceneBuilder& builder) {
  const Surface light = {.color = {0.93F, 0.83F, 0.64F}, .diffuse = 0.9F};
  const Surface dark = {.color = {0.45F, 0.25F, 0.13F}, .diffuse = 0.9F};
  for (std::size_t row = 0; row < 8; ++row) {
    for (std::size_t column = 0; column < 8; ++column) {
      builder.set_surface((row + column) % 2 == 0 ? light : dark);
      const glm::dvec3 middle = middle_of(row, column);
      const std::array<glm::dvec3, 4> square = {
          {middle + glm::dvec3(-0.5, -0.5, 0.0), middle + glm::dvec3(0.5, -0.5, 0.0),
           middle + glm::dvec3(0.5, 0.5, 0.0), middle + glm::dvec3(-0.5, 0.5, 0.0)}};
      builder.add_polygon(square);
    }
  }
}

void add_pieces(SceneBuilder& builder) {
  const Surface white = {
      .color = {0.96F, 0.90F, 0.76F}, .diffuse = 0.85F, .specular = 0.35F, .shine = 40.0F};
  const Surface black = {
      .color = {0.20F, 0.13F, 0.11F}, .diffuse = 0.85F, .specular = 0.45F, .shine = 40.0F};
  const ChessSet set;
  for (std::size_t row = 0; row < 8; ++row) {
    for (std::size_t column = 0; column < 8; ++column) {
      const char name = kPosition[row][column];
      if (name == '.') continue;
      const bool is_white = name < 'a';
      builder.set_surface(is_white ? white : black);
      const glm::dmat4 place = glm::translate(glm::dmat4(1.0), middle_of(row, column));
      const char kind = is_white ? static_cast<char>(name - 'A' + 'a') : name;
      modelling::add_smooth(
          builder,
          modelling::transformed(set.piece(kind),
                                 is_white ? place : place * modelling::rotation(2, 180.0)),
          {.crease = 40.0});
    }
  }
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {-6.2F, -10.8F, 8.6F},
                      .at = {0.1F, -0.4F, 0.0F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .angle = 43.0F});
  builder.set_background({0.36, 0.47, 0.52});
  builder.add_light({-8.0, -4.0, 14.0}, glm::dvec3(0.8));
  builder.add_light({10.0, -12.0, 9.0}, glm::dvec3(0.4));

  add_squares(builder);
  add_pieces(builder);
  builder.set_surface(
      {.color = {0.34F, 0.16F, 0.08F}, .diffuse = 0.85F, .specular = 0.3F, .shine = 30.0F});
  modelling::add_flat(builder,
                      modelling::subdivided_to(modelling::square_ring(4.7, 4.0, -0.35, 0.08),
                                               kPolygons - builder.primitive_count()));
  return std::move(builder).build();
}

}  // namespace

void register_ajedrez(Catalogue& catalogue) {
  catalogue.add(
      {"ajedrez",
       "The thesis's Ajedrez: a chess set of 19,734 polygons on its board, in the Spanish opening",
       {},
       generate});
}

}  // namespace beambench::scenes::generators

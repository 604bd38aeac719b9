#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/base/portable_math.hpp"
#include "scenes/generators/thesis/plant.hpp"
#include "scenes/generators/thesis/room/room.hpp"
#include "scenes/modelling/implicit_surface.hpp"
#include "scenes/modelling/lathe.hpp"
#include "scenes/modelling/parametric_surface.hpp"
#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/modelling/sweep.hpp"

namespace beambench::scenes::generators {
namespace {

Surface glazed(const glm::vec3& color) {
  return {.color = color, .diffuse = 0.85F, .specular = 0.6F, .shine = 60.0F};
}
const Surface kChina = glazed({0.95F, 0.95F, 0.92F});
const Surface kBlueChina = glazed({0.22F, 0.38F, 0.68F});

/// Returns a tube along a spline, tapering from one radius to another, without the parts inside
/// `body`.
modelling::PolygonMesh spout_or_handle(const std::vector<glm::dvec3>& knots, double from, double to,
                                       const modelling::Field& body) {
  const std::vector<glm::dvec3> path = modelling::spline(knots, 3);
  std::vector<double> radii;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(path.size() - 1);
    radii.push_back(std::lerp(from, to, share));
  }
  return modelling::outside(modelling::tube(path, radii, 10), body);
}

modelling::PolygonMesh apple(double radius) {
  constexpr int kStacks = 10;
  std::vector<glm::dvec2> profile;
  for (int i = 0; i <= kStacks; ++i) {
    const double angle = std::numbers::pi * i / kStacks;
    const double height = -portable_cos(angle);
    const double top = std::max(0.0, height);
    const double dimple = top * top * top * top;
    const double r = i == kStacks || i == 0 ? 0.0 : radius * portable_sin(angle);
    profile.emplace_back(r, radius * (0.92 * height - 0.28 * dimple * dimple));
  }
  return modelling::lathe(profile, 16);
}

modelling::PolygonMesh stalk(double radius) {
  const std::vector<glm::dvec3> path = {
      {0.0, 0.0, 0.62 * radius}, {0.003, 0.0, 0.85 * radius}, {0.010, 0.002, 1.12 * radius}};
  const std::vector<double> radii = {0.0022, 0.0022, 0.003};
  return modelling::tube(path, radii, 6, modelling::Caps::kEnd);
}

modelling::PolygonMesh banana() {
  const std::vector<glm::dvec3> knots = {{-0.095, 0.0, 0.045}, {-0.055, 0.012, 0.012},
                                         {0.0, 0.018, 0.0},    {0.055, 0.012, 0.014},
                                         {0.085, 0.0, 0.040},  {0.098, -0.006, 0.062}};
  const std::vector<glm::dvec3> path = modelling::spline(knots, 3);
  std::vector<double> radii;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(path.size() - 1);
    const double off = 2.0 * s - 0.9;
    const double thickness = std::sqrt(std::max(0.0, 1.0 - off * off * off * off));
    radii.push_back(s > 0.86 ? 0.006 : 0.018 * thickness);
  }
  radii.front() = 0.004;
  return modelling::tube(path, radii, 10, modelling::Caps::kBoth);
}

/// Adds a daisy that faces +z: petals around a dome.
void add_daisy(SceneBuilder& builder, const glm::dmat4& place, const glm::vec3& color) {
  constexpr int kPetals = 10;
  modelling::PolygonMesh petals;
  for (int i = 0; i < kPetals; ++i) {
    const double azimuth = 2.0 * std::numbers::pi * i / kPetals;
    const double lift = i % 2 == 0 ? 0.002 : 0.0;
    const glm::dvec3 root(0.010 * portable_cos(azimuth), 0.010 * portable_sin(azimuth), lift);
    modelling::append(petals, arching_leaf({root, azimuth, 0.55, 0.25, 0.040, 0.021}, 3));
  }
  PlacedPiece daisy(builder, place);
  daisy.smooth({.color = color, .diffuse = 0.95F}, petals);
  modelling::Profile dome({0.013, 0.0});
  dome.curve({0.0, 0.012}, 0.005, 3);
  daisy.smooth({.color = {0.95F, 0.72F, 0.15F}, .diffuse = 0.9F},
               modelling::lathe(dome.points(), 10));
}

}  // namespace

void add_china_teapot(SceneBuilder& builder, const glm::dmat4& place) {
  PlacedPiece pot(builder, place);
  modelling::Profile body({0.048, 0.0});
  body.line({0.050, 0.008}).curve({0.052, 0.125}, 0.048, 11).line({0.050, 0.130});
  pot.smooth(kBlueChina, modelling::lathe(body.points(), 28));
  modelling::Profile lid({0.054, 0.128});
  lid.line({0.054, 0.133})
      .curve({0.010, 0.150}, 0.006, 5)
      .line({0.008, 0.156})
      .ball(0.166, 0.013, 7);
  pot.smooth(kChina, modelling::lathe(lid.points(), 28));
  const modelling::Field inside = [](const glm::dvec3& p) {
    return modelling::ellipsoid_field(p, {0.0, 0.0, 0.066}, {0.094, 0.094, 0.072});
  };
  pot.smooth(kBlueChina,
             spout_or_handle(
                 {{0.075, 0.0, 0.05}, {0.115, 0.0, 0.065}, {0.135, 0.0, 0.10}, {0.162, 0.0, 0.128}},
                 0.021, 0.010, inside));
  pot.smooth(kBlueChina, spout_or_handle({{-0.075, 0.0, 0.108},
                                          {-0.115, 0.0, 0.120},
                                          {-0.142, 0.0, 0.095},
                                          {-0.128, 0.0, 0.055},
                                          {-0.080, 0.0, 0.036}},
                                         0.0085, 0.0085, inside));
}

void add_cup(SceneBuilder& builder, const glm::dmat4& place) {
  PlacedPiece cup(builder, place);
  modelling::Profile saucer({0.074, 0.012});
  saucer.line({0.074, 0.015}).curve({0.034, 0.006}, 0.002, 4).line({0.022, 0.006});
  cup.smooth(kChina, modelling::lathe(saucer.points(), 24));
  modelling::Profile body({0.022, 0.006});
  body.line({0.023, 0.011}).curve({0.041, 0.058}, 0.008, 5).line({0.039, 0.058});
  body.curve({0.036, 0.044}, 0.0, 2);
  cup.smooth(kChina, modelling::lathe(body.points(), 20));
  const std::vector<glm::dvec2> tea = {{0.036, 0.044}, {0.0, 0.044}};
  cup.flat({.color = {0.52F, 0.25F, 0.09F}, .diffuse = 0.8F, .specular = 0.5F, .shine = 60.0F},
           modelling::lathe(tea, 20));
  const modelling::Field inside = [](const glm::dvec3& p) {
    return std::sqrt(p.x * p.x + p.y * p.y) - 0.024 - 0.3 * (p.z - 0.006);
  };
  cup.smooth(kChina, spout_or_handle({{0.030, 0.0, 0.049},
                                      {0.050, 0.0, 0.053},
                                      {0.062, 0.0, 0.040},
                                      {0.050, 0.0, 0.025},
                                      {0.026, 0.0, 0.022}},
                                     0.0036, 0.0036, inside));
}

void add_fruit_bowl(SceneBuilder& builder, const glm::dmat4& place) {
  modelling::Profile bowl({0.062, 0.0});
  bowl.line({0.060, 0.012}).curve({0.170, 0.075}, 0.020, 6).line({0.164, 0.077});
  bowl.curve({0.065, 0.018}, -0.019, 6).line({0.0, 0.015});
  PlacedPiece(builder, place).smooth(kChina, modelling::lathe(bowl.points(), 32));

  struct Fruit {
    glm::dvec3 place;
    double radius;
    glm::vec3 color;
    bool is_apple;
  };
  constexpr std::array<Fruit, 6> kFruit = {
      {{{0.075, 0.02, 0.075}, 0.041, {0.76F, 0.13F, 0.12F}, true},
       {{-0.015, 0.080, 0.076}, 0.042, {0.95F, 0.55F, 0.12F}, false},
       {{-0.082, 0.010, 0.075}, 0.040, {0.58F, 0.72F, 0.22F}, true},
       {{-0.035, -0.072, 0.074}, 0.041, {0.78F, 0.16F, 0.13F}, true},
       {{0.045, -0.070, 0.075}, 0.041, {0.95F, 0.57F, 0.14F}, false},
       {{-0.008, 0.004, 0.128}, 0.041, {0.80F, 0.20F, 0.14F}, true}}};
  for (const Fruit& fruit : kFruit) {
    PlacedPiece piece(builder, place * standing_at(fruit.place, 700.0 * fruit.place.x));
    const modelling::PolygonMesh body =
        fruit.is_apple ? apple(fruit.radius)
                       : modelling::ellipsoid(glm::dvec3(fruit.radius), 16, 12);
    // The bowl and the other fruit hide the lower part.
    piece.smooth(glazed(fruit.color), above(body, -0.35 * fruit.radius));
    if (!fruit.is_apple) continue;
    piece.smooth({.color = {0.35F, 0.22F, 0.10F}, .diffuse = 0.9F}, stalk(fruit.radius));
  }
  PlacedPiece(builder, place * standing_at({0.085, 0.045, 0.118}, 60.0))
      .smooth({.color = {0.96F, 0.82F, 0.22F}, .diffuse = 0.9F, .specular = 0.2F, .shine = 20.0F},
              banana());
}

void add_vase_of_flowers(SceneBuilder& builder, const glm::dmat4& place) {
  modelling::Profile vase({0.040, 0.0});
  vase.curve({0.066, 0.10}, 0.014, 6)
      .curve({0.026, 0.20}, 0.008, 6)
      .curve({0.040, 0.235}, -0.006, 4);
  vase.line({0.037, 0.236}).curve({0.023, 0.20}, 0.006, 4);
  PlacedPiece(builder, place)
      .smooth(glazed({0.24F, 0.56F, 0.55F}), modelling::lathe(vase.points(), 24));

  struct Flower {
    glm::dvec3 head;
    glm::vec3 color;
  };
  constexpr std::array<Flower, 7> kFlowers = {{{{0.0, -0.01, 0.47}, {0.98F, 0.97F, 0.94F}},
                                               {{0.085, -0.03, 0.43}, {0.97F, 0.62F, 0.70F}},
                                               {{-0.085, -0.02, 0.44}, {0.98F, 0.97F, 0.94F}},
                                               {{0.035, 0.08, 0.45}, {0.98F, 0.97F, 0.94F}},
                                               {{-0.05, 0.07, 0.41}, {0.97F, 0.62F, 0.70F}},
                                               {{-0.03, -0.10, 0.39}, {0.97F, 0.62F, 0.70F}},
                                               {{0.055, -0.105, 0.37}, {0.98F, 0.97F, 0.94F}}}};
  modelling::PolygonMesh stems;
  for (const Flower& flower : kFlowers) {
    const glm::dvec3 low(0.12 * flower.head.x, 0.12 * flower.head.y, 0.19);
    const glm::dvec3 bend =
        0.5 * (low + flower.head) - glm::dvec3(0.25 * flower.head.x, 0.25 * flower.head.y, 0.0);
    const std::vector<glm::dvec3> knots = {low, bend, flower.head};
    const std::vector<glm::dvec3> path = modelling::spline(knots, 2);
    const std::vector<double> radii(path.size(), 0.0028);
    modelling::append(stems, modelling::tube(path, radii, 5));
    // The flower faces along its stem.
    const glm::dvec3 up = glm::normalize(flower.head - bend);
    const glm::dvec3 side = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), up));
    const glm::dmat4 head(glm::dvec4(side, 0.0), glm::dvec4(glm::cross(up, side), 0.0),
                          glm::dvec4(up, 0.0), glm::dvec4(flower.head, 1.0));
    add_daisy(builder, place * head, flower.color);
  }
  modelling::PolygonMesh leaves;
  for (int i = 0; i < 6; ++i) {
    modelling::append(leaves,
                      arching_leaf({{0.0, 0.0, 0.20}, 1.1 * i + 0.3, 1.25, 0.5, 0.19, 0.035}, 7));
  }
  PlacedPiece green(builder, place);
  green.smooth({.color = {0.30F, 0.52F, 0.20F}, .diffuse = 0.9F}, stems);
  green.smooth({.color = {0.25F, 0.50F, 0.22F}, .diffuse = 0.9F}, leaves);
}

}  // namespace beambench::scenes::generators

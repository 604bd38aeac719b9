#include <array>
#include <vector>

#include "scenes/generators/thesis/room/room.hpp"
#include "scenes/modelling/box.hpp"
#include "scenes/modelling/lathe.hpp"
#include "scenes/modelling/parametric_surface.hpp"
#include "scenes/modelling/sweep.hpp"

namespace beambench::scenes::generators {
namespace {

const Surface kOak = {
    .color = {0.55F, 0.33F, 0.16F}, .diffuse = 0.85F, .specular = 0.4F, .shine = 40.0F};
const Surface kDarkOak = {
    .color = {0.40F, 0.22F, 0.11F}, .diffuse = 0.85F, .specular = 0.4F, .shine = 40.0F};
const Surface kSeat = {.color = {0.72F, 0.22F, 0.17F}, .diffuse = 0.9F};

/// Returns a round rod, thicker in its middle.
modelling::PolygonMesh rod(const glm::dvec3& from, const glm::dvec3& to, double radius, int sides) {
  const std::array<glm::dvec3, 5> path = {
      {from, 0.75 * from + 0.25 * to, 0.5 * (from + to), 0.25 * from + 0.75 * to, to}};
  const std::array<double, 5> radii = {0.8 * radius, 0.95 * radius, radius, 0.95 * radius,
                                       0.8 * radius};
  return modelling::tube(path, radii, sides);
}

/// Returns the corner posts of a rectangle around the origin.
std::array<glm::dvec3, 4> posts(double x, double y) {
  return {{{-x, -y, 0.0}, {x, -y, 0.0}, {x, y, 0.0}, {-x, y, 0.0}}};
}

/// Returns the back's bow: from the seat up one side, over and down the other.
std::vector<glm::dvec3> bow() {
  const std::vector<glm::dvec3> knots = {
      {-0.19, 0.17, 0.44},  {-0.205, 0.215, 0.62}, {-0.19, 0.26, 0.80},
      {-0.11, 0.285, 0.91}, {0.0, 0.292, 0.935},   {0.11, 0.285, 0.91},
      {0.19, 0.26, 0.80},   {0.205, 0.215, 0.62},  {0.19, 0.17, 0.44}};
  return modelling::spline(knots, 3);
}

/// Returns a board with a round edge, open under the cushion.
modelling::PolygonMesh seat_board() {
  modelling::Profile edge({0.0, -0.5});
  edge.line({0.80, -0.5}).curve({1.0, 0.1}, 0.06, 3).curve({0.90, 0.5}, 0.05, 2);
  edge.line({0.66, 0.42});  // the middle is hidden under the cushion
  modelling::PolygonMesh mesh = modelling::lathe(edge.points(), 28);
  for (glm::dvec3& vertex : mesh.vertices) {
    // Turns the circle into a rounded square that is narrower at the back.
    const double x = vertex.x * (1.0 + 0.14 * vertex.y * vertex.y);
    const double y = vertex.y * (1.0 + 0.14 * vertex.x * vertex.x);
    vertex = {0.225 * x * (1.0 - 0.07 * y), 0.215 * y, 0.445 + 0.036 * vertex.z};
  }
  return mesh;
}

/// Returns a turned leg from the floor up, open at both ends.
modelling::PolygonMesh turned_leg(double height, double radius, int sides) {
  const double r = radius;
  const double h = height;
  modelling::Profile profile({0.50 * r, 0.0});
  profile.curve({0.56 * r, 0.10 * h}, 0.18 * r, 3)
      .line({0.42 * r, 0.12 * h})
      .curve({0.42 * r, 0.17 * h}, 0.25 * r, 3)
      .curve({0.72 * r, 0.52 * h}, 0.14 * r, 4)
      .curve({0.50 * r, 0.70 * h}, -0.05 * r, 2)
      .curve({0.50 * r, 0.76 * h}, 0.30 * r, 3)
      .line({0.86 * r, 0.79 * h})
      .line({0.86 * r, h});
  return modelling::lathe(profile.points(), sides);
}

}  // namespace

void add_dining_table(SceneBuilder& builder, const glm::dmat4& place) {
  constexpr double kRadius = 0.56;
  PlacedPiece table(builder, place);
  modelling::Profile top({0.07, kDiningTop - 0.035});
  top.line({kRadius - 0.05, kDiningTop - 0.035})
      .curve({kRadius, kDiningTop - 0.012}, 0.008, 3)
      .curve({kRadius - 0.012, kDiningTop}, 0.004, 2)
      .line({0.40, kDiningTop})
      .line({0.0, kDiningTop});
  table.smooth(kOak, modelling::lathe(top.points(), 44));
  modelling::Profile column({0.05, 0.11});
  column.curve({0.085, 0.20}, 0.015, 3)
      .line({0.06, 0.22})
      .curve({0.06, 0.26}, 0.02, 4)
      .curve({0.075, 0.42}, 0.035, 5)
      .curve({0.040, 0.56}, -0.012, 4)
      .curve({0.045, 0.60}, 0.022, 4)
      .line({0.05, 0.62})
      .curve({0.13, kDiningTop - 0.035}, -0.015, 4);
  table.smooth(kDarkOak, modelling::lathe(column.points(), 20));
  for (int foot = 0; foot < 4; ++foot) {
    const std::vector<glm::dvec3> knots = {
        {0.05, 0.0, 0.17}, {0.18, 0.0, 0.15}, {0.32, 0.0, 0.055}, {0.42, 0.0, 0.026}};
    const std::vector<glm::dvec3> path = modelling::spline(knots, 3);
    std::vector<double> radii;
    for (std::size_t i = 0; i < path.size(); ++i) {
      radii.push_back(0.042 - 0.0019 * static_cast<double>(i));
    }
    PlacedPiece(builder, place * standing_at({0.0, 0.0, 0.0}, 45.0 + 90.0 * foot))
        .smooth(kDarkOak, modelling::tube(path, radii, 10, modelling::Caps::kEnd));
  }
}

void add_coffee_table(SceneBuilder& builder, const glm::dmat4& place) {
  PlacedPiece table(builder, place);
  table.flat(kDarkOak, modelling::beveled_box({-0.58, -0.31, kCoffeeTop - 0.035},
                                              {0.58, 0.31, kCoffeeTop}, 0.008));
  table.flat(kDarkOak, modelling::beveled_box({-0.50, -0.24, 0.105}, {0.50, 0.24, 0.13}, 0.005));
  modelling::PolygonMesh rails;
  for (const double y : {-0.262, 0.238}) {
    modelling::append(
        rails, modelling::box({-0.5, y, kCoffeeTop - 0.10}, {0.5, y + 0.024, kCoffeeTop - 0.036}));
  }
  for (const double x : {-0.532, 0.508}) {
    modelling::append(rails, modelling::box({x, -0.23, kCoffeeTop - 0.10},
                                            {x + 0.024, 0.23, kCoffeeTop - 0.036}));
  }
  table.flat(kDarkOak, rails);
  for (const glm::dvec3& post : posts(0.52, 0.25)) {
    PlacedPiece(builder, place * standing_at(post))
        .smooth(kDarkOak, turned_leg(kCoffeeTop - 0.035, 0.036, 12));
  }
}

void add_chair(SceneBuilder& builder, const glm::dmat4& place) {
  PlacedPiece chair(builder, place);
  chair.smooth(kOak, seat_board());
  modelling::PolygonMesh cushion = modelling::ellipsoid({0.185, 0.175, 0.045}, 24, 14);
  for (glm::dvec3& vertex : cushion.vertices) {
    vertex += glm::dvec3(0.0, -0.01, 0.468);
  }
  chair.smooth(kSeat, above(cushion, 0.462));

  // The legs are splayed and joined by an H of stretchers.
  std::array<glm::dvec3, 4> low;
  std::size_t leg = 0;
  for (const glm::dvec3& top : posts(0.15, 0.14)) {
    glm::dmat4 splayed = place;
    const glm::dvec3 foot = 1.38 * top;
    const glm::dvec3 way = top + glm::dvec3(0.0, 0.0, 0.44) - foot;
    splayed = place * standing_at(foot);
    splayed[2] += place * glm::dvec4((way / 0.44 - glm::dvec3(0.0, 0.0, 1.0)), 0.0);
    PlacedPiece(builder, splayed).smooth(kOak, turned_leg(0.436, 0.026, 10));
    low[leg++] = foot + (0.16 / 0.44) * way;
  }
  modelling::PolygonMesh rods = rod(low[0], low[3], 0.014, 8);
  modelling::append(rods, rod(low[1], low[2], 0.014, 8));
  modelling::append(rods, rod(0.5 * (low[0] + low[3]), 0.5 * (low[1] + low[2]), 0.014, 8));

  const std::vector<glm::dvec3> path = bow();
  const std::vector<double> radii(path.size(), 0.0135);
  modelling::append(rods, modelling::tube(path, radii, 8));
  // The spindles run from the seat to points of the bow.
  for (const int i : {8, 10, 12, 14, 16}) {
    const glm::dvec3& up = path[static_cast<std::size_t>(i)];
    modelling::append(rods, rod({0.72 * up.x, 0.175, 0.45}, up, 0.0085, 6));
  }
  chair.smooth(kOak, rods);
}

}  // namespace beambench::scenes::generators

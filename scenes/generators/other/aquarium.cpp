#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>

#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/generators/other/fish.hpp"
#include "scenes/generators/thesis/plant.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/box.hpp"
#include "scenes/modelling/lathe.hpp"
#include "scenes/modelling/parametric_surface.hpp"
#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/modelling/subdivide.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr Surface kWater{.color = {0.75F, 0.92F, 0.95F},
                         .diffuse = 0.04F,
                         .specular = 0.1F,
                         .shine = 60.0F,
                         .transmittance = 0.85F,
                         .refraction_index = 1.33F};
const glm::dvec3 kLower(-1.6, 0.0, 0.0);  // the corners of the body of water
const glm::dvec3 kUpper(1.6, 1.3, 1.75);
constexpr double kGap = 0.02;   // distance from the water to everything outside
constexpr double kBed = 0.02;   // distance from the water's bottom face to the stones
constexpr double kSide = 0.04;  // distance from the water's upright faces to the stones

glm::dmat4 placed(const glm::dvec3& place, double heading) {
  return glm::translate(glm::dmat4(1.0), place) * modelling::rotation(2, heading);
}

void add(SceneBuilder& builder, const modelling::PolygonMesh& mesh, const glm::vec3& color) {
  builder.set_surface({.color = color});
  modelling::add_flat(builder, modelling::triangulated(mesh));
}

/// Adds a bed of 3 `detail` x `detail` stones, which have 36 triangles each and may overlap.
void add_stones(SceneBuilder& builder, int detail) {
  constexpr std::array<glm::vec3, 4> kColors = {
      {{0.72F, 0.62F, 0.48F}, {0.55F, 0.50F, 0.45F}, {0.80F, 0.74F, 0.62F}, {0.60F, 0.46F, 0.34F}}};
  Random random(5);
  const glm::dvec2 lower = glm::dvec2(kLower) + kSide;
  const glm::dvec2 upper = glm::dvec2(kUpper) - kSide;
  const glm::ivec2 count(3 * detail, detail);
  const glm::dvec2 cell = (upper - lower) / glm::dvec2(count);
  const double largest = 0.62 * std::min(cell.x, 0.7 * cell.y);
  for (int y = 0; y < count.y; ++y) {
    for (int x = 0; x < count.x; ++x) {
      const double radius = largest * random.uniform(0.8, 1.0);
      const double height = 0.6 * radius;
      glm::dvec2 place;
      for (int i = 0; i < 2; ++i) {
        const double at = ((i == 0 ? x : y) + random.uniform(0.2, 0.8)) / count[i];
        place[i] = glm::mix(lower[i] + radius, upper[i] - radius, at);
      }
      const double heading = random.uniform(0.0, 180.0);
      const glm::vec3& color = kColors[random.below(kColors.size())];
      const modelling::PolygonMesh stone =
          modelling::ellipsoid({radius, 0.75 * radius, height}, 6, 4);
      add(builder,
          modelling::transformed(stone,
                                 placed(glm::dvec3(place, kLower.z + kBed + height), heading)),
          color);
    }
  }
}

/// The colors of a shoal.
struct Colors {
  glm::vec3 body, stripe, fin;
};

struct Swimmer {
  glm::dvec3 place;
  double heading, climb;  ///< degrees: turned about z, then head up
  double length;
  std::size_t colors;
};

void add_fish(SceneBuilder& builder, int detail) {
  constexpr std::array<Colors, 3> kColors = {
      {{{0.95F, 0.42F, 0.08F}, {0.95F, 0.93F, 0.88F}, {0.85F, 0.30F, 0.05F}},
       {{0.95F, 0.80F, 0.15F}, {0.15F, 0.16F, 0.22F}, {0.90F, 0.70F, 0.10F}},
       {{0.15F, 0.40F, 0.80F}, {0.55F, 0.80F, 0.95F}, {0.10F, 0.25F, 0.55F}}}};
  constexpr std::array<Swimmer, 12> kSwimmers = {{{{-0.55, 0.45, 0.95}, 12.0, 5.0, 0.62, 0},
                                                  {{0.55, 0.40, 1.25}, 170.0, -4.0, 0.52, 0},
                                                  {{0.15, 0.55, 0.62}, -10.0, 8.0, 0.46, 0},
                                                  {{1.10, 0.50, 0.75}, 195.0, 6.0, 0.48, 1},
                                                  {{-1.10, 0.50, 0.50}, 20.0, -6.0, 0.44, 1},
                                                  {{-0.15, 0.85, 1.42}, 8.0, 0.0, 0.42, 1},
                                                  {{-1.15, 0.60, 1.40}, -15.0, 0.0, 0.32, 2},
                                                  {{-0.85, 0.80, 1.50}, -12.0, 4.0, 0.30, 2},
                                                  {{-0.70, 0.45, 1.36}, -18.0, -3.0, 0.30, 2},
                                                  {{0.95, 0.85, 1.48}, 200.0, 0.0, 0.34, 2},
                                                  {{1.22, 0.70, 1.30}, 190.0, 3.0, 0.30, 2},
                                                  {{0.50, 0.90, 0.90}, 165.0, 0.0, 0.36, 2}}};
  constexpr glm::vec3 kEye(0.05F, 0.05F, 0.06F);
  const Fish shape = fish(detail);
  for (const Swimmer& swimmer : kSwimmers) {
    const glm::dmat4 place =
        glm::scale(placed(swimmer.place, swimmer.heading) * modelling::rotation(1, -swimmer.climb),
                   glm::dvec3(swimmer.length));
    const Colors& colors = kColors[swimmer.colors];
    modelling::add_painted(builder, modelling::transformed(shape.mesh, place),
                           [&](std::size_t i) -> Surface {
                             switch (shape.part[i]) {
                               case FishPart::kBody:
                                 return {.color = colors.body};
                               case FishPart::kStripe:
                                 return {.color = colors.stripe};
                               case FishPart::kFin:
                                 return {.color = colors.fin};
                               case FishPart::kEye:
                                 break;
                             }
                             return {.color = kEye};
                           });
  }
}

/// Adds five plants with nine leaves each. Every leaf has 8 `detail` - 2 triangles.
void add_plants(SceneBuilder& builder, int detail) {
  struct Plant {
    glm::dvec2 root;
    double length;
    glm::vec3 color;
  };
  constexpr std::array<Plant, 5> kPlants = {{{{-1.15, 0.85}, 1.15, {0.20F, 0.50F, 0.16F}},
                                             {{-0.30, 0.95}, 0.85, {0.35F, 0.55F, 0.15F}},
                                             {{0.40, 0.80}, 0.55, {0.50F, 0.25F, 0.20F}},
                                             {{0.85, 0.90}, 1.05, {0.16F, 0.45F, 0.22F}},
                                             {{1.20, 0.40}, 0.45, {0.40F, 0.55F, 0.20F}}}};
  Random random(9);
  for (const Plant& plant : kPlants) {
    for (int i = 0; i < 9; ++i) {
      ArchingLeaf leaf{};
      leaf.root = glm::dvec3(plant.root, 0.06);
      leaf.azimuth = 0.698 * i + random.uniform(-0.2, 0.2);
      leaf.rise = random.uniform(1.45, 1.55);
      leaf.fall = random.uniform(-1.2, -0.9);
      leaf.length = plant.length * random.uniform(0.75, 1.0);
      leaf.width = 0.07;
      add(builder, arching_leaf(leaf, 2 * detail), plant.color);
    }
  }
}

/// Adds an open amphora of 16 `detail`^2 triangles that lies on the stones.
void add_amphora(SceneBuilder& builder, int detail) {
  std::vector<glm::dvec2> profile;
  for (int i = 0; i <= 2 * detail; ++i) {
    const double s = static_cast<double>(i) / (2 * detail);
    profile.emplace_back(0.07 + 0.62 * s * (1.0 - s) * (1.15 - s), 0.55 * s);
  }
  add(builder,
      modelling::transformed(modelling::lathe(profile, 4 * detail),
                             placed({-0.25, 0.42, 0.24}, 25.0) * modelling::rotation(1, 74.0)),
      {0.70F, 0.38F, 0.24F});
}

/// Adds bubbles that rise from the amphora.
void add_bubbles(SceneBuilder& builder) {
  Random random(3);
  for (int i = 0; i < 24; ++i) {
    const double radius = random.uniform(0.008, 0.02);
    const double x = 0.32 + random.uniform(-0.05, 0.05);
    const double y = 0.66 + random.uniform(-0.05, 0.05);
    add(builder,
        modelling::transformed(modelling::ellipsoid(glm::dvec3(radius), 6, 4),
                               placed({x, y, 0.3 + 0.058 * i}, 0.0)),
        {0.92F, 0.96F, 1.0F});
  }
}

/// Adds the frame around the water: posts joined by bars at the top. It does not touch the water.
void add_frame(SceneBuilder& builder) {
  constexpr double kWidth = 0.06;
  const std::array<double, 4> x = {kLower.x - kGap - kWidth, kLower.x - kGap, kUpper.x + kGap,
                                   kUpper.x + kGap + kWidth};
  const std::array<double, 4> y = {kLower.y - kGap - kWidth, kLower.y - kGap, kUpper.y + kGap,
                                   kUpper.y + kGap + kWidth};
  const double top = kUpper.z + kGap + kWidth;
  modelling::PolygonMesh frame;
  for (const std::size_t i : {0U, 2U}) {
    for (const std::size_t k : {0U, 2U}) {
      modelling::append(frame, modelling::box({x[i], y[k], -kGap}, {x[i + 1], y[k + 1], top}));
    }
    modelling::append(frame, modelling::box({x[i], y[1], top - kWidth}, {x[i + 1], y[2], top}));
    modelling::append(frame, modelling::box({x[1], y[i], top - kWidth}, {x[2], y[i + 1], top}));
  }
  add(builder, frame, {0.12F, 0.12F, 0.14F});
}

/// Adds the cabinet below the water and a wall of 6 `detail` x 4 `detail` tiles behind it.
void add_surroundings(SceneBuilder& builder, int detail) {
  add(builder, modelling::box({-2.2, -0.5, -1.0}, {2.2, 2.1, -kGap}), {0.50F, 0.33F, 0.20F});
  const auto plane = [](double u, double v) {
    return glm::dvec3(6.0 * u - 3.0, 2.1, 3.9 * v - 1.0);
  };
  constexpr std::array<Surface, 3> kTiles = {{{.color = {0.90F, 0.90F, 0.86F}},
                                              {.color = {0.20F, 0.36F, 0.62F}},
                                              {.color = {0.55F, 0.72F, 0.85F}}}};
  const auto columns = static_cast<std::size_t>(6 * detail);
  modelling::add_painted(
      builder,
      modelling::triangulated(modelling::parametric_surface(plane, 6 * detail, 4 * detail)),
      [&](std::size_t triangle) {
        const std::size_t column = triangle / 2 % columns;
        const std::size_t row = triangle / 2 / columns;
        return kTiles[(column + row) % 2 == 0 ? 0 : column % 4 == (row + 1) % 4 ? 1 : 2];
      });
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {0.4F, -4.9F, 1.3F},
                      .at = {0.03F, 0.0F, 0.82F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .angle = 32.0F,
                      .aspect = 4.0F / 3.0F,
                      .width = 640,
                      .height = 480});
  builder.set_background({0.10, 0.11, 0.13});
  builder.add_light({-2.0, -3.5, 4.0}, glm::dvec3(0.6));
  builder.add_light({2.5, -3.0, 2.5}, glm::dvec3(0.35));
  builder.add_light({0.3, 0.6, 4.5}, glm::dvec3(0.5));

  const auto detail = static_cast<int>(parameters.integer("detail"));
  builder.set_surface(kWater);
  modelling::add_flat(builder, modelling::box(kLower, kUpper));
  add_stones(builder, detail);
  add_fish(builder, detail);
  add_plants(builder, detail);
  add_amphora(builder, detail);
  add_bubbles(builder);
  add_frame(builder);
  add_surroundings(builder, detail);
  return std::move(builder).build();
}

}  // namespace

void register_aquarium(Catalogue& catalogue) {
  catalogue.add(
      {"aquarium",
       "A box of water with fish, plants and stones in it, before a wall of tiles: 268 d^2 + "
       "408 d + 2178 triangles and 6 faces of water (22,600 by default)",
       {integer_parameter("detail", 8, 1, 100, "d: fineness of all parts")},
       generate,
       "detail"});
}

}  // namespace beambench::scenes::generators

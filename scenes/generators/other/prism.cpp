#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <glm/ext/matrix_transform.hpp>

#include "scenes/catalogue.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/box.hpp"
#include "scenes/modelling/extrusion.hpp"
#include "scenes/modelling/letters.hpp"
#include "scenes/modelling/parametric_surface.hpp"
#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/modelling/subdivide.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr Surface kGlass{.color = {0.90F, 0.97F, 0.94F},
                         .diffuse = 0.06F,
                         .specular = 0.1F,
                         .shine = 60.0F,
                         .transmittance = 0.85F,
                         .refraction_index = 1.5F};
constexpr double kGap = 0.03;  // gap between the glass and the table
constexpr double kHalfWidth = 4.5;
constexpr double kWallHeight = 3.6;
constexpr double kWall = 3.0;  // the y of the wall

glm::dmat4 standing(const glm::dvec3& place, double heading) {
  return glm::translate(glm::dmat4(1.0), place) * modelling::rotation(2, heading);
}

void add(SceneBuilder& builder, const modelling::PolygonMesh& mesh, const glm::vec3& color) {
  builder.set_surface({.color = color});
  modelling::add_flat(builder, modelling::triangulated(mesh));
}

/// Adds two separate bodies: a prism with angles of 30, 60 and 90 degrees and an upright face
/// turned toward the camera, and a plate. The corners of an upright face have only two positions in
/// x and y and two in z, so that the face stays flat when the corners are rounded.
void add_glass(SceneBuilder& builder) {
  builder.set_surface(kGlass);
  const modelling::PolygonMesh prism =
      modelling::extruded(modelling::flat_polygon({{-1.3, 0.0}, {1.3, 0.0}, {-1.3, 1.5}}), 2.0);
  modelling::add_flat(builder, modelling::transformed(prism, standing({-0.95, -0.3, kGap}, 12.0)));
  const modelling::PolygonMesh plate = modelling::box({-0.8, 0.0, 0.0}, {0.8, 0.4, 1.6});
  modelling::add_flat(builder, modelling::transformed(plate, standing({1.42, -0.6, kGap}, -16.0)));
}

/// Adds a wall of 5 d x 2 d tiles in two colors, each with a raised letter.
void add_wall(SceneBuilder& builder, int detail) {
  const int columns = 5 * detail;
  const int rows = 2 * detail;
  const auto plane = [](double u, double v) {
    return glm::dvec3(kHalfWidth * (2.0 * u - 1.0), kWall, kWallHeight * v);
  };
  constexpr std::array<Surface, 2> kTiles = {
      {{.color = {0.93F, 0.91F, 0.84F}}, {.color = {0.80F, 0.84F, 0.84F}}}};
  modelling::add_painted(
      builder, modelling::triangulated(modelling::parametric_surface(plane, columns, rows)),
      [&](std::size_t triangle) {
        const std::size_t tile = triangle / 2;
        const auto width = static_cast<std::size_t>(columns);
        return kTiles[(tile % width + tile / width) % 2];
      });

  constexpr std::array<std::string_view, 2> kWords = {"TABLE", "BLEAT"};  // anagrams
  constexpr std::array<glm::vec3, 4> kColors = {
      {{0.72F, 0.12F, 0.10F}, {0.08F, 0.25F, 0.55F}, {0.10F, 0.42F, 0.20F}, {0.45F, 0.15F, 0.45F}}};
  const double side = 2.0 * kHalfWidth / columns;
  const double height = 0.62 * side;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const std::string_view word = kWords[static_cast<std::size_t>(row) % 2];
      const std::string_view text = word.substr(static_cast<std::size_t>(column) % 5, 1);
      const glm::dvec3 corner(
          side * (column + 0.5) - kHalfWidth - 0.5 * modelling::text_width(text, height), kWall,
          side * row + 0.5 * (side - height));
      const modelling::PolygonMesh body =
          modelling::extruded_text(text, height, 0.2 * height, modelling::Ends::kFront);
      add(builder,
          modelling::transformed(
              body, glm::translate(glm::dmat4(1.0), corner) * modelling::rotation(0, 90.0)),
          kColors[static_cast<std::size_t>(column / 5 + 3 * row) % 4]);
    }
  }
}

/// Adds five rows of 3 d blocks on the table, before the wall.
void add_blocks(SceneBuilder& builder, int detail) {
  constexpr std::array<glm::vec3, 5> kColors = {{{0.85F, 0.30F, 0.12F},
                                                 {0.95F, 0.75F, 0.20F},
                                                 {0.25F, 0.55F, 0.30F},
                                                 {0.20F, 0.45F, 0.75F},
                                                 {0.60F, 0.30F, 0.55F}}};
  const int columns = 3 * detail;
  const double spacing = 2.0 * (kHalfWidth - 0.3) / columns;
  const double half = std::min(0.3 * spacing, 0.12);
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < columns; ++column) {
      const int kind = 3 * column + 7 * row;
      const double height = half * (1.2 + 0.6 * (kind % 4));
      const glm::dvec3 place(0.3 - kHalfWidth + spacing * (column + 0.25 + 0.5 * (row % 2)),
                             1.4 + 0.34 * row, 0.0);
      const modelling::PolygonMesh block =
          modelling::beveled_box({-half, -half, 0.0}, {half, half, height}, 0.15 * half);
      add(builder, modelling::transformed(block, standing(place, 17.0 * (kind % 5))),
          kColors[static_cast<std::size_t>(kind) % 5]);
    }
  }
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {0.3F, -6.6F, 3.3F},
                      .at = {-0.05F, 0.0F, 1.14F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .angle = 31.0F,
                      .aspect = 4.0F / 3.0F,
                      .width = 640,
                      .height = 480});
  builder.set_background({0.10, 0.11, 0.13});
  builder.add_light({-3.5, -5.0, 6.5}, glm::dvec3(0.55));
  builder.add_light({4.0, -4.0, 5.0}, glm::dvec3(0.35));
  builder.add_light({0.5, 0.8, 6.0}, glm::dvec3(0.3));

  const auto detail = static_cast<int>(parameters.integer("detail"));
  add_glass(builder);
  add_wall(builder, detail);
  add_blocks(builder, detail);
  add(builder, modelling::box({-kHalfWidth, -3.0, -0.2}, {kHalfWidth, kWall, 0.0}),
      {0.55F, 0.38F, 0.24F});
  return std::move(builder).build();
}

}  // namespace

void register_prism(Catalogue& catalogue) {
  catalogue.add(
      {"prism",
       "A prism and a plate of glass before a wall of letters and rows of blocks: 336 d^2 + 660 "
       "d + 12 triangles and 11 faces of glass (26,807 by default)",
       {integer_parameter("detail", 8, 1, 100, "d: fineness of all parts")},
       generate,
       "detail"});
}

}  // namespace beambench::scenes::generators

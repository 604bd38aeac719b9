#include <array>
#include <utility>
#include <vector>

#include "scenes/base/portable_math.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/generators/moving/motion.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kTurn = 6.283185307179586;
constexpr double kWidth = 3.0;  // the sheet is 3 wide, from its pole at x = 0, and 2 high
constexpr double kHeight = 2.0;

/// A vertex of the sheet at (u, v) in [0, 1]^2, when `passed` waves have gone by. The waves run
/// from the pole to the free edge and grow on their way; a second one runs obliquely.
glm::dvec3 on_sheet(double u, double v, double passed) {
  const double first = portable_sin(kTurn * (1.6 * u + 0.15 * v - passed));
  const double second = portable_sin(kTurn * (2.7 * u - 0.6 * v - 2.0 * passed));
  const double sag = portable_cos(kTurn * (1.6 * u - passed));
  const double reach = u * (2.0 - u);  // 0 at the pole
  return {kWidth * u * (1.0 - 0.06 * reach) + 0.05 * reach * second,
          reach * (0.34 * first + 0.09 * second), kHeight * v - 0.10 * u * u + 0.06 * reach * sag};
}

/// Three stripes with a disk in the middle.
Surface surface_at(double u, double v) {
  const double x = kWidth * (u - 0.5);
  const double z = kHeight * (v - 0.5);
  Surface surface{
      .color = {0.80F, 0.16F, 0.14F}, .diffuse = 0.85F, .specular = 0.15F, .shine = 15.0F};
  if (v > 0.27 && v < 0.73) surface.color = {0.93F, 0.90F, 0.82F};
  if (x * x + z * z < 0.32 * 0.32) surface.color = {0.12F, 0.30F, 0.58F};
  return surface;
}

Animation animate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  add_wide_camera(builder, "default", {1.6, -5.0, 1.7}, {1.42, 0.0, 0.97}, 36.0F);
  add_wide_camera(builder, "along", {5.2, -2.0, 2.3}, {1.4, 0.0, 0.95}, 36.0F);
  light_motion(builder, 3.0);

  const std::uint32_t k = cells_for(parameters.integer("triangles"));
  const std::uint32_t frames = frames_of(parameters);
  const std::size_t vertices = (std::size_t{k} + 1) * (k + 1);
  const auto places = [k, frames, vertices](std::uint32_t frame) {
    std::vector<glm::dvec3> all;
    all.reserve(vertices);
    for (std::size_t i = 0; i < vertices; ++i) {
      all.push_back(on_sheet(static_cast<double>(i % (k + 1)) / k,
                             static_cast<double>(i / (k + 1)) / k,
                             static_cast<double>(frame) / frames));
    }
    return all;
  };
  builder.reserve_triangles(vertices, 2 * std::size_t{k} * k);
  for (const glm::dvec3& place : places(0)) builder.add_vertex(place);
  for (std::uint32_t row = 0; row < k; ++row) {
    for (std::uint32_t column = 0; column < k; ++column) {
      builder.set_surface(surface_at((column + 0.5) / k, (row + 0.5) / k));
      const std::uint32_t a = row * (k + 1) + column;
      const std::uint32_t c = a + k + 2;
      builder.add_polygon(std::array{a, a + 1, c});
      builder.add_polygon(std::array{a, c, a + k + 1});
    }
  }
  return with_moving_vertices(std::move(builder).build(), frames, places);
}

}  // namespace

void register_waving_sheet(Catalogue& catalogue) {
  catalogue.add({.name = "waving-sheet",
                 .summary =
                     "A sheet of 2 k^2 triangles (20,000 by default), fixed at one edge; waves "
                     "travel along it, once per cycle of its frames",
                 .parameters = {integer_parameter("triangles", 20000, 2, 20000000,
                                                  "number of triangles, rounded to 2 k^2"),
                                frames_parameter()},
                 .size_parameter = "triangles",
                 .animate = animate});
}

}  // namespace beambench::scenes::generators

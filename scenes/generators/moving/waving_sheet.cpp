#include <array>
#include <utility>
#include <vector>

#include "scenes/base/portable_math.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/generators/moving/motion.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kWidth = 3.0;  // the sheet is 3 wide, from its pole at x = 0, and 2 high
constexpr double kHeight = 2.0;

/// Returns the vertex of the sheet at (u, v) in [0, 1]^2 after `passed` waves have gone by. The
/// waves run from the pole to the free edge and grow on their way; a second series runs obliquely.
glm::dvec3 on_sheet(double u, double v, double passed) {
  const double first = portable_sin(kFullTurn * (1.6 * u + 0.15 * v - passed));
  const double second = portable_sin(kFullTurn * (2.7 * u - 0.6 * v - 2.0 * passed));
  const double sag = portable_cos(kFullTurn * (1.6 * u - passed));
  const double reach = u * (2.0 - u);  // 0 at the pole
  return {kWidth * u * (1.0 - 0.06 * reach) + 0.05 * reach * second,
          reach * (0.34 * first + 0.09 * second), kHeight * v - 0.10 * u * u + 0.06 * reach * sag};
}

/// Returns the surface of the stripe at v, one of five from blue to gold.
Surface surface_at(double v) {
  constexpr std::array<glm::vec3, 5> kColors = {{{0.13F, 0.24F, 0.46F},
                                                 {0.42F, 0.24F, 0.48F},
                                                 {0.74F, 0.27F, 0.40F},
                                                 {0.91F, 0.48F, 0.26F},
                                                 {0.96F, 0.78F, 0.38F}}};
  return {.color = kColors[static_cast<std::size_t>(5.0 * v)], .diffuse = 0.95F};
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
    builder.set_surface(surface_at((row + 0.5) / k));
    for (std::uint32_t column = 0; column < k; ++column) {
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
                     "travel along it, once per cycle of the frames",
                 .parameters = {integer_parameter("triangles", 20000, 2, 20000000,
                                                  "number of triangles, rounded to 2 k^2"),
                                frames_parameter()},
                 .size_parameter = "triangles",
                 .animate = animate});
}

}  // namespace beambench::scenes::generators

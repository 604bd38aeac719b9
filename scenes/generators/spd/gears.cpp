#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/vec2.hpp>

#include "scenes/base/portable_math.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/generators/spd/spd_sky.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr int kTeeth = 36;
constexpr int kRim = 4 * kTeeth;     // corners of a face: two at a tooth's tip, two at its foot
constexpr double kTipRatio = 0.995;  // relative to the outer radius: meshing gears keep a gap
constexpr double kFootRatio = 0.9;   // relative to the outer radius
constexpr double kThickness = 0.1;   // maximum thickness

/// The outline of a gear around the origin, counter-clockwise from the first tooth's tip.
using Outline = std::array<glm::dvec2, kRim>;

Outline outline(double outer_radius, double turned_by) {
  // The positions of the corners between the middle of one tooth and the next.
  constexpr std::array<double, 4> kPlaces = {-0.19, 0.19, 0.3, 0.7};
  constexpr double kPitch = 2.0 * std::numbers::pi / kTeeth;
  Outline corners{};
  for (std::size_t i = 0; i < kRim; ++i) {
    const std::size_t place = i % 4;
    const double radius = outer_radius * (place < 2 ? kTipRatio : kFootRatio);
    const double angle = turned_by + kPitch * (static_cast<double>(i / 4) + kPlaces[place]);
    corners[i] = {radius * portable_cos(angle), radius * portable_sin(angle)};
  }
  return corners;
}

/// Adds a gear: its upper face, the quads around it, and its lower face, over 2 kRim shared
/// vertices.
void add_gear(SceneBuilder& builder, const Outline& corners, const glm::dvec3& center,
              double thickness) {
  std::array<std::uint32_t, kRim> upper{};
  std::array<std::uint32_t, kRim> lower{};
  for (std::size_t i = 0; i < kRim; ++i) {
    const glm::dvec3 corner = center + glm::dvec3(corners[i], 0.0);
    upper[i] = builder.add_vertex(corner);
    lower[i] = builder.add_vertex(corner - glm::dvec3(0.0, 0.0, thickness));
  }
  builder.add_polygon(upper);
  for (std::size_t i = 0; i < kRim; ++i) {
    const std::size_t next = (i + 1) % kRim;
    builder.add_polygon(std::array{upper[i], lower[i], lower[next], upper[next]});
  }
  // The corners are in reverse, because the face points down, but start at the same tooth.
  std::array<std::uint32_t, kRim> face{};
  for (std::size_t i = 0; i < kRim; ++i) face[i] = lower[(kRim + 1 - i) % kRim];
  builder.add_polygon(face);
}

/// Returns a surface whose color looks random and is brightened until its largest component is 1.
/// Every fifth gear is glass.
Surface gear_surface(std::int64_t x, std::int64_t y, std::int64_t z) {
  const auto component = [](std::int64_t sevenths) {
    return 0.01 + static_cast<double>(sevenths % 7) / 7.0;
  };
  const glm::dvec3 color(component(5 * (3 * x + 2 * y + z + 1)),
                         component(3 * (3 * y + 2 * z + x + 1)),
                         component(2 * (3 * z + 2 * x + y + 1)));
  Surface surface;
  surface.color = color / std::max({color.x, color.y, color.z});
  if ((4 * x + 2 * y + z) % 5 == 0) {
    surface.diffuse = 0.2F;
    surface.transmittance = 0.8F;
    surface.refraction_index = 1.1F;
  }
  return surface;
}

void add_gears(SceneBuilder& builder, std::int64_t n) {
  const auto count = static_cast<double>(n);
  const double outer_radius = 1.0 / (count - (count - 1.0) * (1.0 - kFootRatio) / 2.0);
  const double thickness = std::min(kThickness, 1.0 / (2.0 * count));
  const double spacing = outer_radius * (1.0 + kFootRatio);
  // Neighboring gears are turned by half a tooth.
  const std::array<Outline, 2> outlines = {outline(outer_radius, 0.0),
                                           outline(outer_radius, std::numbers::pi / kTeeth)};
  for (std::int64_t z = 0; z < n; ++z) {
    for (std::int64_t y = 0; y < n; ++y) {
      for (std::int64_t x = 0; x < n; ++x) {
        builder.set_surface(gear_surface(x, y, z));
        const glm::dvec3 center(outer_radius - 1.0 + spacing * static_cast<double>(x),
                                outer_radius - 1.0 + spacing * static_cast<double>(y),
                                1.0 - static_cast<double>(z) / count);
        add_gear(builder, outlines[static_cast<std::size_t>((x + y + z) % 2)], center, thickness);
      }
    }
  }
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {-1.1F, -2.1F, 2.6F},
                      .at = {0.0F, 0.0F, 0.0F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .hither = 1.0F});
  builder.set_background(kSpdSky);
  builder.add_light({2.0, 4.0, 4.0});
  builder.add_light({-2.0, 4.0, 3.0});
  builder.add_light({2.0, -2.5, 2.5});
  builder.add_light({-1.0, -4.0, 2.0});
  builder.add_light({-1.111, -2.121, 2.626});

  builder.set_surface(
      {.color = {1.0F, 0.85F, 0.7F}, .diffuse = 0.3F, .specular = 0.6F, .shine = 3.0827F});
  builder.add_polygon(std::array<glm::dvec3, 4>{
      {{2.0, 2.0, 0.0}, {-2.0, 2.0, 0.0}, {-2.0, -2.0, 0.0}, {2.0, -2.0, 0.0}}});
  add_gears(builder, parameters.integer("n"));
  return std::move(builder).build();
}

}  // namespace

void register_gears(Catalogue& catalogue) {
  catalogue.add(
      {"gears",
       "Meshing gears of 2 n^3 concave 144-gons and 144 n^3 quads over a square (Haines's SPD)",
       {integer_parameter("n", 4, 1, 45, "gears along each axis")},
       generate,
       "n"});
}

}  // namespace beambench::scenes::generators

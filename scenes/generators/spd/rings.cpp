#include <array>
#include <cmath>
#include <numbers>

#include "scenes/base/portable_math.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/generators/spd/spd_sky.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadius = 0.07412;  // of cylinders and spheres; rings nearly touch

/// Six pentagons around the origin whose 30 corners are the middles of a dodecahedron's edges.
using Pentagons = std::array<std::array<glm::dvec3, 5>, 6>;

Pentagons pentagons() {
  const double scale = 1.0 / (1.0 + kRadius);  // the rings together fit a sphere of radius 1
  // The cosine of the angle between neighboring faces of a dodecahedron is -1 / sqrt 5.
  const double tilt_cos = -std::sqrt(1.0 / 5.0);
  const double tilt_sin = std::sqrt(4.0 / 5.0);
  Pentagons rings{};
  for (std::size_t i = 0; i < 5; ++i) {
    const double angle = 2.0 * kPi / 5.0 * static_cast<double>(i);
    const glm::dvec3 flat(scale * portable_cos(angle), scale * portable_sin(angle), 0.0);
    rings[0][i] = flat;
    const glm::dvec3 tilted(flat.x, flat.y * tilt_cos, flat.y * tilt_sin);
    for (std::size_t ring = 1; ring < 6; ++ring) {
      const double turn = kPi / 5.0 * (2.0 * static_cast<double>(ring) - 1.0);
      const double c = portable_cos(turn);
      const double s = portable_sin(turn);
      rings[ring][i] = {c * tilted.x - s * tilted.y, s * tilted.x + c * tilted.y, tilted.z};
    }
  }
  return rings;
}

constexpr std::array<glm::vec3, 6> kColors = {{{1.0F, 0.0F, 0.0F},
                                               {0.0F, 1.0F, 0.0F},
                                               {0.0F, 0.0F, 1.0F},
                                               {0.0F, 1.0F, 1.0F},
                                               {1.0F, 0.0F, 1.0F},
                                               {1.0F, 1.0F, 0.0F}}};

void add_rings(SceneBuilder& builder, const Pentagons& rings, const glm::dvec3& center) {
  for (std::size_t ring = 0; ring < 6; ++ring) {
    builder.set_surface(
        {.color = kColors[ring], .diffuse = 0.5F, .specular = 0.2F, .shine = 3.0827F});
    for (std::size_t i = 0; i < 5; ++i) {
      const glm::dvec3 corner = center + rings[ring][i];
      builder.add_cone(corner, kRadius, center + rings[ring][(i + 4) % 5], kRadius);
      builder.add_sphere(corner, kRadius);
    }
  }
}

/// Adds the pyramid: layer k, counted away from the eye, has k x k objects.
void add_pyramid(SceneBuilder& builder, std::int64_t layers, double layer_distance) {
  const Pentagons rings = pentagons();
  for (std::int64_t depth = 0; depth < layers; ++depth) {
    for (std::int64_t z = 0; z <= depth; ++z) {
      for (std::int64_t x = 0; x <= depth; ++x) {
        add_rings(
            builder, rings,
            {static_cast<double>(2 * x - depth), layer_distance * static_cast<double>(depth + 1),
             static_cast<double>(2 * z - depth)});
      }
    }
  }
}

/// Adds a wall behind the pyramid, 1% larger than the field of view.
void add_wall(SceneBuilder& builder, const glm::dvec3& eye, double y) {
  const double tan_half_view = std::sqrt(2.0) - 1.0;  // of 22.5 degrees
  const double half = 1.01 * (y - eye.y) * tan_half_view;
  const auto corner = [&](double x, double z) {
    return glm::dvec3(eye.x + x * half, y, eye.z + z * half);
  };
  builder.set_surface({});
  builder.add_polygon(std::array{corner(1, 1), corner(-1, 1), corner(-1, -1), corner(1, -1)});
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  const double spread = 1.0 / portable_sin(kPi / 8.0);  // the pyramid fills the view
  const glm::dvec3 eye(-1.0, -spread, 0.5);
  builder.add_camera({.from = eye,
                      .at = eye + glm::dvec3(0.0, 1.0, 0.0),
                      .up = {0.0F, 0.0F, 1.0F},
                      .hither = 1.0F});
  builder.set_background(kSpdSky);
  builder.add_light({3.0, -spread, 3.0});
  builder.add_light({-4.0, -spread, 1.0});
  builder.add_light({2.0, -spread, -4.0});

  const std::int64_t n = parameters.integer("n");
  add_wall(builder, eye, spread * static_cast<double>(n + 1));
  add_pyramid(builder, n, spread);
  return std::move(builder).build();
}

}  // namespace

void register_rings(Catalogue& catalogue) {
  catalogue.add(
      {"rings",
       "Pyramid of pentagonal rings: 5 n (n+1) (2n+1) spheres and as many cylinders before a "
       "wall (Haines's SPD)",
       {integer_parameter("n", 7, 1, 90, "layers of the pyramid")},
       generate,
       "n"});
}

}  // namespace beambench::scenes::generators

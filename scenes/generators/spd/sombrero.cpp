#include <array>
#include <cmath>
#include <numbers>

#include "scenes/base/portable_math.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/generators/spd/spd_sky.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kHalfSize = 4.0;
constexpr double kFloor = -3.0;

double ripple(double x, double z) {
  const double r = std::sqrt(x * x + z * z);
  return portable_cos(2.0 * std::numbers::pi * r) * portable_exp(-r);
}

/// Adds a height field of `width` x `width` points. As in the SPD, the heights are computed for a
/// grid of `width` cells but placed on a grid of `width` - 1 cells, so the hat is slightly off
/// center.
void add_hat(SceneBuilder& builder, std::uint32_t width) {
  const double sampled = 2.0 * kHalfSize / width;
  const double spaced = 2.0 * kHalfSize / (width - 1);
  for (std::uint32_t i = 0; i < width; ++i) {
    for (std::uint32_t j = 0; j < width; ++j) {
      builder.add_vertex({-kHalfSize + j * spaced,
                          kFloor + ripple(-kHalfSize + j * sampled, -kHalfSize + i * sampled),
                          -kHalfSize + i * spaced});
    }
  }
  for (std::uint32_t i = 0; i + 1 < width; ++i) {
    for (std::uint32_t j = 0; j + 1 < width; ++j) {
      const std::uint32_t near = i * width + j;
      const std::uint32_t far = near + width;
      builder.add_polygon(std::array{near, far + 1, near + 1});
      builder.add_polygon(std::array{near, far, far + 1});
    }
  }
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {0.0F, 5.0F, -8.0F},
                      .at = {0.0F, 0.0F, 0.0F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .angle = 40.0F,
                      .hither = 0.01F});
  builder.set_background(kSpdSky);
  builder.add_light({10.0, 10.0, -10.0});
  builder.set_surface({.color = {1.0F, 0.1F, 0.1F}, .diffuse = 0.8F});
  add_hat(builder, 32U << static_cast<std::uint32_t>(parameters.integer("n") - 1));
  return std::move(builder).build();
}

}  // namespace

void register_sombrero(Catalogue& catalogue) {
  catalogue.add({"sombrero",
                 "Height field of 2 (32 * 2^(n-1) - 1)^2 triangles (SPD)",
                 {integer_parameter("n", 1, 1, 8, "each step doubles the points along both sides")},
                 generate,
                 "n"});
}

}  // namespace beambench::scenes::generators

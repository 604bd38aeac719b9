#include "scenes/generators/spd/shells.hpp"

#include <numbers>

#include "scenes/base/portable_math.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/generators/spd/spd_sky.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {-6.0F, -60.0F, 35.0F},
                      .at = {0.0F, 8.0F, -15.0F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .hither = 0.5F});
  builder.set_background(kSpdSky);
  builder.add_light({-100.0, -100.0, 100.0});
  builder.set_surface(
      {.color = {1.0F, 0.8F, 0.4F}, .diffuse = 0.8F, .specular = 0.2F, .shine = 45.2776F});
  add_shell(builder, std::int64_t{180} << parameters.integer("n"));
  return std::move(builder).build();
}

}  // namespace

/// Adds Pickover's shell (IEEE CG&A 9(6), 1989): spheres as large as their distance from the axis,
/// along a spiral that grows by e^(0.15 theta), with six turns below theta = 0 and three above.
void add_shell(SceneBuilder& builder, std::int64_t steps, std::int64_t left_out) {
  constexpr double kTurns = 9.0;
  constexpr double kGrowth = 0.15;
  constexpr double kPitch = -2.0;
  for (std::int64_t i = left_out - 2 * steps / 3; i <= steps / 3; ++i) {
    const double theta =
        kTurns * 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(steps);
    const double rho = portable_exp(kGrowth * theta);
    builder.add_sphere({rho * portable_sin(theta), rho * portable_cos(theta), kPitch * rho}, rho);
  }
}

void register_shells(Catalogue& catalogue) {
  catalogue.add({"shells",
                 "Seashell of 180 * 2^n + 1 nearly concentric spheres (Haines's SPD)",
                 {integer_parameter("n", 5, 0, 16, "each step doubles the shell's spheres")},
                 generate,
                 "n"});
}

}  // namespace beambench::scenes::generators

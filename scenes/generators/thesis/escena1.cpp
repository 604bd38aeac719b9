#include "scenes/catalogue.hpp"
#include "scenes/generators/other/scattered_balls.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  light_balls(builder);
  const std::vector<Ball> balls = scattered_balls(
      parameters.integer("spheres"), static_cast<std::uint64_t>(parameters.integer("seed")));
  for (std::size_t i = 0; i < balls.size(); ++i) {
    builder.set_surface(surface_of_ball(i, balls.size()));
    builder.add_sphere(balls[i].center, balls[i].radius);
  }
  return std::move(builder).build();
}

}  // namespace

void register_escena1(Catalogue& catalogue) {
  catalogue.add(
      {"escena1",
       "The thesis's Escena 1: spheres of different sizes at random, nearly uniform over the "
       "volume",
       {integer_parameter("seed", 1999, 0, 0xFFFFFFFF, "seed of the random numbers"),
        integer_parameter("spheres", 430, 1, 10000000, "number of spheres")},
       generate,
       "spheres"});
}

}  // namespace beambench::scenes::generators

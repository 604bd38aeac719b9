#include <array>

#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

/// Returns a random point of the cube [-half, half]^3.
glm::dvec3 point_in_cube(Random& random, double half) {
  const double x = random.uniform(-half, half);
  const double y = random.uniform(-half, half);
  return {x, y, random.uniform(-half, half)};
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  Camera camera;
  camera.from = {3.5F, 2.2F, 2.1F};
  camera.at = {0.0F, 0.0F, 0.0F};
  camera.up = {0.0F, 0.0F, 1.0F};
  builder.add_camera(camera);
  builder.set_background({0.078, 0.361, 0.753});
  builder.add_light({5.0, 1.0, 4.0});
  builder.add_light({1.0, 6.0, 2.0});
  builder.set_surface({.color = {0.75F, 0.80F, 0.35F}, .diffuse = 0.9F});

  const std::int64_t count = parameters.integer("triangles");
  std::int64_t cells = 1;  // along each axis of a grid with at least one cell per triangle
  while (cells * cells * cells < count) ++cells;
  const double reach = 0.6 / static_cast<double>(cells);  // from a triangle's center to a corner
  Random random(static_cast<std::uint64_t>(parameters.integer("seed")));
  for (std::int64_t i = 0; i < count; ++i) {
    const glm::dvec3 middle = point_in_cube(random, 1.0);
    std::array<glm::dvec3, 3> corners;
    for (glm::dvec3& corner : corners) corner = middle + point_in_cube(random, reach);
    builder.add_polygon(corners);
  }
  return std::move(builder).build();
}

}  // namespace

void register_soup(Catalogue& catalogue) {
  catalogue.add(
      {"soup",
       "Small triangles at random in a cube; no two share a corner, and the more triangles there "
       "are, the smaller they get",
       {integer_parameter("seed", 1, 0, 0xFFFFFFFF, "seed of the random numbers"),
        integer_parameter("triangles", 20000, 1, 20000000, "number of triangles")},
       generate,
       "triangles"});
}

}  // namespace beambench::scenes::generators

#include <glm/ext/matrix_transform.hpp>

#include "scenes/catalogue.hpp"
#include "scenes/generators/thesis/escena1.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/parametric_surface.hpp"
#include "scenes/modelling/subdivide.hpp"

namespace beambench::scenes::generators {
namespace {

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  light_balls(builder);
  const auto slices = static_cast<int>(parameters.integer("slices"));
  const modelling::PolygonMesh unit_ball =
      modelling::triangulated(modelling::ellipsoid(glm::dvec3(1.0), slices, slices / 2));
  const std::vector<Ball> balls = scattered_balls(
      parameters.integer("spheres"), static_cast<std::uint64_t>(parameters.integer("seed")));
  for (std::size_t i = 0; i < balls.size(); ++i) {
    builder.set_surface(surface_of_ball(i, balls.size()));
    const glm::dmat4 place = glm::translate(glm::dmat4(1.0), balls[i].center);
    modelling::add_flat(
        builder, modelling::transformed(unit_ball, glm::scale(place, glm::dvec3(balls[i].radius))));
  }
  return std::move(builder).build();
}

}  // namespace

void register_tessellated_balls(Catalogue& catalogue) {
  catalogue.add({"tessellated-balls",
                 "The balls of escena1 as closed meshes of triangles: 96,320 by default",
                 {integer_parameter("seed", 1999, 0, 0xFFFFFFFF, "seed of the random numbers"),
                  integer_parameter("slices", 16, 4, 256,
                                    "pieces around each ball; half as many from pole to pole"),
                  integer_parameter("spheres", 430, 1, 100000, "number of balls")},
                 generate,
                 "spheres"});
}

}  // namespace beambench::scenes::generators

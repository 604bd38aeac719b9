#include <vector>

#include <glm/ext/matrix_transform.hpp>

#include "scenes/base/portable_math.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/box.hpp"
#include "scenes/modelling/lathe.hpp"
#include "scenes/modelling/parametric_surface.hpp"
#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/modelling/subdivide.hpp"

namespace beambench::scenes::generators {
namespace {

const glm::dvec3 kRoom(10.0, 8.0, 4.0);  // the corner opposite the origin

modelling::PolygonMesh moved(modelling::PolygonMesh mesh, const glm::dvec3& to) {
  return modelling::transformed(std::move(mesh), glm::translate(glm::dmat4(1.0), to));
}

modelling::PolygonMesh ball(double radius, int slices, int stacks) {
  return modelling::ellipsoid(glm::dvec3(radius), slices, stacks);
}

/// Returns the room's six sides, facing inward and divided into 3 d x 2 d x d squares. They are
/// closed and share edges.
modelling::PolygonMesh shell(int detail) {
  modelling::PolygonMesh sides;
  for (int axis = 0; axis < 3; ++axis) {
    const int u_axis = (axis + 1) % 3;
    const int v_axis = (axis + 2) % 3;
    for (const double level : {0.0, kRoom[axis]}) {
      // Seen from inside, the lower and upper sides of an axis have opposite windings.
      const bool upper = level > 0.0;
      const auto surface = [&](double u, double v) {
        glm::dvec3 point;
        point[axis] = level;
        point[u_axis] = kRoom[u_axis] * (upper ? v : u);
        point[v_axis] = kRoom[v_axis] * (upper ? u : v);
        return point;
      };
      const int u_steps = (3 - u_axis) * detail;
      const int v_steps = (3 - v_axis) * detail;
      modelling::append(sides, modelling::parametric_surface(surface, upper ? v_steps : u_steps,
                                                             upper ? u_steps : v_steps));
    }
  }
  return modelling::welded(sides);
}

/// Returns a column from floor to ceiling with a gentle wave.
modelling::PolygonMesh column(int detail) {
  const int stacks = 2 * detail;
  std::vector<glm::dvec2> profile;
  for (int i = 0; i <= stacks; ++i) {
    const double up = static_cast<double>(i) / stacks;
    profile.emplace_back(0.25 + 0.05 * portable_sin(14.4 * up), kRoom.z * up);
  }
  return modelling::lathe(profile, 4 * detail);
}

/// Returns a table top on four square legs, centered at the origin on the floor.
modelling::PolygonMesh table() {
  constexpr double kTop = 0.71;
  const std::vector<glm::dvec2> leg = {{0.06, 0.0}, {0.06, kTop}};
  modelling::PolygonMesh mesh = modelling::box({-0.7, -0.5, kTop}, {0.7, 0.5, kTop + 0.08});
  for (const double x : {-0.6, 0.6}) {
    for (const double y : {-0.4, 0.4})
      modelling::append(mesh, moved(modelling::lathe(leg, 4, 0.125), {x, y, 0.0}));
  }
  return mesh;
}

void add(SceneBuilder& builder, const modelling::PolygonMesh& mesh, const glm::vec3& color) {
  builder.set_surface({.color = color, .diffuse = 0.85F, .specular = 0.15F, .shine = 20.0F});
  modelling::add_flat(builder, modelling::triangulated(mesh));
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {0.8F, 7.0F, 1.9F},
                      .at = {6.0F, 3.0F, 1.2F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .angle = 65.0F});
  builder.add_light({5.0, 4.0, 3.7}, glm::dvec3(0.8));
  builder.add_light({1.5, 6.0, 3.0}, glm::dvec3(0.4));

  const auto detail = static_cast<int>(parameters.integer("detail"));
  add(builder, shell(detail), {0.86F, 0.82F, 0.74F});
  for (int i = 0; i < 6; ++i) {
    for (const double y : {0.7, 7.3}) {
      add(builder, moved(column(detail), {1.0 + 1.6 * i, y, 0.0}), {0.80F, 0.78F, 0.80F});
    }
  }
  for (int i = 0; i < 4; ++i) {
    const glm::dvec3 place(1.8 + 2.1 * i, 4.6 - 0.3 * i, 0.0);
    add(builder, moved(table(), place), {0.50F, 0.32F, 0.18F});
    add(builder, moved(ball(0.25, 6 * detail, 3 * detail), place + glm::dvec3(0.0, 0.0, 1.04)),
        {0.75F, 0.25F, 0.20F});
    add(builder, moved(ball(0.1, 4 * detail, 2 * detail), place + glm::dvec3(0.5, -0.2, 0.89)),
        {0.25F, 0.45F, 0.70F});
  }
  for (int i = 0; i < 6; ++i) {
    const glm::dvec3 place(0.8 + 1.5 * i, i % 2 == 0 ? 4.0 : 3.7, 3.3);
    add(builder, moved(ball(0.18, 3 * detail, 2 * detail), place), {0.95F, 0.90F, 0.65F});
  }
  return std::move(builder).build();
}

}  // namespace

void register_closed_room(Catalogue& catalogue) {
  catalogue.add(
      {"closed-room",
       "A closed hall of columns, tables and balls, seen from inside: 516 d^2 - 116 d + 176 "
       "triangles (32,272 by default)",
       {integer_parameter("detail", 8, 1, 140, "d: fineness of all parts")},
       generate,
       "detail"});
}

}  // namespace beambench::scenes::generators

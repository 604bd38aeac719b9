#include <array>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "scenes/base/portable_math.hpp"
#include "scenes/base/rotation.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/generators/moving/motion.hpp"
#include "scenes/modelling/box.hpp"
#include "scenes/modelling/extrusion.hpp"
#include "scenes/modelling/parametric_surface.hpp"
#include "scenes/modelling/subdivide.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

using modelling::PolygonMesh;

constexpr double kSpacing = 2.3;  // distance between rings; approximate between solids of a ring

PolygonMesh torus(int detail) {
  return modelling::parametric_surface(
      [](double u, double v) {
        const double reach = 0.58 + 0.26 * portable_cos(kFullTurn * v);
        return glm::dvec3(reach * portable_cos(kFullTurn * u), reach * portable_sin(kFullTurn * u),
                          0.26 * portable_sin(kFullTurn * v));
      },
      4 * detail, 2 * detail);
}

/// Returns a tube along a trefoil knot.
PolygonMesh knot(int detail) {
  const auto point = [](double u, double v) {
    const double t = kFullTurn * u;
    const glm::dvec3 place(portable_sin(t) + 2.0 * portable_sin(2.0 * t),
                           portable_cos(t) - 2.0 * portable_cos(2.0 * t), -portable_sin(3.0 * t));
    const glm::dvec3 tangent = glm::normalize(
        glm::dvec3(portable_cos(t) + 4.0 * portable_cos(2.0 * t),
                   -portable_sin(t) + 4.0 * portable_sin(2.0 * t), -3.0 * portable_cos(3.0 * t)));
    // The tangent is never vertical.
    const glm::dvec3 side = glm::normalize(glm::cross(tangent, glm::dvec3(0.0, 0.0, 1.0)));
    const glm::dvec3 up = glm::cross(side, tangent);
    return 0.29 *
           (place + 0.55 * (portable_cos(kFullTurn * v) * side + portable_sin(kFullTurn * v) * up));
  };
  return modelling::parametric_surface(point, 12 * detail, detail + 2);
}

PolygonMesh star() {
  std::vector<glm::dvec2> outline;
  for (int i = 0; i < 10; ++i) {
    const double radius = i % 2 == 0 ? 0.95 : 0.42;
    outline.emplace_back(radius * portable_cos(kFullTurn * i / 10.0),
                         radius * portable_sin(kFullTurn * i / 10.0));
  }
  PolygonMesh mesh = modelling::extruded(modelling::flat_polygon(std::move(outline)), 0.4);
  return modelling::transformed(std::move(mesh), moved_by({0.0, 0.0, -0.2}));
}

struct Solid {
  PolygonMesh mesh;
  glm::vec3 color;
};

std::array<Solid, 5> solids_of(int detail) {
  return {
      {{knot(detail), {0.86F, 0.42F, 0.20F}},
       {modelling::beveled_box(glm::dvec3(-0.55), glm::dvec3(0.55), 0.08), {0.24F, 0.46F, 0.70F}},
       {torus(detail), {0.93F, 0.76F, 0.28F}},
       {star(), {0.75F, 0.20F, 0.28F}},
       {modelling::ellipsoid({0.85, 0.6, 0.42}, 4 * detail, 2 * detail), {0.40F, 0.62F, 0.38F}}}};
}

/// A position in one of the rings about the z axis, which have 6, 12, 18... positions.
struct Place {
  double ring;
  double along;  ///< fraction of the ring
};

Place place_of(std::size_t solid) {
  std::size_t ring = 1;
  for (; solid >= 6 * ring; ++ring) solid -= 6 * ring;
  return {static_cast<double>(ring),
          static_cast<double>(solid) / (6.0 * static_cast<double>(ring))};
}

/// Returns a solid's transform. Every solid turns once about its own axis, rises and sinks, and
/// moves around with its ring; neighboring rings turn in opposite directions.
glm::dmat4 placed(std::size_t solid, double time) {
  const auto [ring, along] = place_of(solid);
  const double direction = static_cast<int>(ring) % 2 == 0 ? -1.0 : 1.0;
  const double angle = kFullTurn * (along + direction * time / 3.0);
  const double number = static_cast<double>(solid);
  const glm::dvec3 center(kSpacing * ring * portable_cos(angle),
                          kSpacing * ring * portable_sin(angle),
                          0.30 * portable_sin(kFullTurn * (time + 0.37 * number)));
  return moved_by(center) * rotation(2, 137.5 * number) * rotation(0, 25.0 + 50.0 * along) *
         rotation(1, 360.0 * time + 40.0 * number) * rotation(0, 65.0);
}

Animation animate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  const auto count = static_cast<std::size_t>(parameters.integer("solids"));
  const double reach = kSpacing * (place_of(count - 1).ring + 0.5);
  add_wide_camera(builder, "default", reach * glm::dvec3(1.0, -1.75, 1.35),
                  {0.0, -0.12 * reach, -0.4}, 39.0F);
  add_wide_camera(builder, "low", reach * glm::dvec3(0.5, -2.0, 0.25), {0.0, 0.0, 0.0}, 36.0F);
  light_motion(builder, reach);

  const auto shapes = solids_of(static_cast<int>(parameters.integer("detail")));
  const std::uint32_t frames = frames_of(parameters);
  RigidParts parts;
  std::vector<PolygonMesh> meshes;
  for (const Solid& shape : shapes) meshes.push_back(modelling::triangulated(shape.mesh));
  for (std::size_t i = 0; i < count; ++i) {
    const PolygonMesh& mesh = meshes[i % meshes.size()];
    parts.vertices.insert(parts.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    parts.ends.push_back(parts.vertices.size());
  }
  parts.place = [frames](std::size_t part, std::uint32_t frame) {
    return placed(part, static_cast<double>(frame) / frames);
  };
  for (const glm::dvec3& place : parts.placed(0)) builder.add_vertex(place);
  for (std::size_t i = 0; i < count; ++i) {
    const PolygonMesh& mesh = meshes[i % meshes.size()];
    builder.set_surface({.color = shapes[i % shapes.size()].color,
                         .diffuse = 0.75F,
                         .specular = 0.25F,
                         .shine = 40.0F});
    const auto first = static_cast<std::uint32_t>(parts.ends[i] - mesh.vertices.size());
    for (const auto& corners : mesh.polygons) {
      builder.add_polygon(std::array{first + corners[0], first + corners[1], first + corners[2]});
    }
  }
  add_floor(builder, 4.0 * reach, -1.5);
  return with_moving_vertices(
      std::move(builder).build(), frames,
      [parts = std::move(parts)](std::uint32_t frame) { return parts.placed(frame); });
}

}  // namespace

void register_turning_solids(Catalogue& catalogue) {
  catalogue.add({.name = "turning-solids",
                 .summary = "Rigid solids of triangles, in rings about a center over a floor; each "
                            "turns, rises and sinks while its ring carries it",
                 .parameters = {integer_parameter("detail", 8, 2, 256,
                                                  "fineness of the round solids, whose number of "
                                                  "triangles grows with its square"),
                                integer_parameter("solids", 18, 1, 100000, "number of solids"),
                                frames_parameter()},
                 .size_parameter = "detail",
                 .animate = animate});
}

}  // namespace beambench::scenes::generators
